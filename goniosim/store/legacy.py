"""Result files of schema 1.0, which nothing writes any more: 512 bytes of text stand before the HDF5 part.

They say how long that part is and what its digest is, so that a file is exactly what was written, or damaged.
"""

import hashlib
import json
import re
import zlib
from collections.abc import Mapping
from typing import BinaryIO

from goniosim.errors import DamagedFileError
from goniosim.store.kinds import RESULT
from goniosim.writing import StrPath

SIZE = 512
MARK = RESULT.mark
_CHECKSUM_AT = SIZE - len("12345678\n")
_FIELDS = re.compile(
    rb"schema 1\.\d+\n.*\nbytes: (\d{1,18})\nsha256: ([0-9a-f]{64})\nattributes-sha256: ([0-9a-f]{64})\n"
)


def read(stream: BinaryIO, path: StrPath) -> tuple[str, str]:
    """Read the first 512 bytes and hold the length of the file against them.

    Parameters
    ----------
    stream : binary file
    path : path-like
        For messages.

    Returns
    -------
    digest, attributes_digest : str
        SHA-256 of the HDF5 part and of the root attributes, hexadecimal.

    Raises
    ------
    DamagedFileError
    """
    length = stream.seek(0, 2) - SIZE
    stream.seek(0)
    block = stream.read(SIZE)
    body, checksum = block[:_CHECKSUM_AT], block[_CHECKSUM_AT:]
    if len(block) < SIZE:
        raise _damaged(path, f"is cut off after {len(block)} bytes")
    fields = _FIELDS.search(body)
    if checksum != b"%08x\n" % zlib.crc32(body) or fields is None:
        raise _damaged(path, f"its first {SIZE} bytes are damaged")
    expected = int(fields[1])
    if length < expected:
        raise _damaged(path, f"is cut off: {length + SIZE} of {expected + SIZE} bytes")
    if length > expected:
        raise _damaged(path, f"has {length - expected} bytes too many")
    return fields[2].decode(), fields[3].decode()


def verify(stream: BinaryIO, digest: str, path: StrPath) -> None:
    """Hold every byte after the first 512 against the digest from `read`."""
    stream.seek(SIZE)
    if hashlib.file_digest(stream, "sha256").hexdigest() != digest:  # type: ignore[arg-type]
        raise _damaged(path, "its content does not match its digest: it was damaged or edited after it was written")


def verify_attributes(attributes: Mapping[str, str | int], digest: str, path: StrPath) -> None:
    """Hold the root attributes against the second digest from `read`."""
    if hashlib.sha256(json.dumps(attributes, sort_keys=True).encode()).hexdigest() != digest:
        raise _damaged(path, "its root attributes are damaged")


def _damaged(path: StrPath, reason: str) -> DamagedFileError:
    return DamagedFileError(f"{path}: {reason}; {RESULT.remedy}")
