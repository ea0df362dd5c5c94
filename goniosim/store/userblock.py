"""The first 512 bytes of a result file: readable text that vouches for all the rest.

HDF5 leaves a user block at the start of a file to the application. Ours says
which schema the file follows, how long the HDF5 part is, and what its digest
is, so that a truncated, altered or newer file is recognised before HDF5 reads
a single number from it. The first line and the closing checksum keep their
form in every version of the schema.
"""

import hashlib
import io
import json
import re
import stat
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from goniosim.errors import DamagedFileError, ForeignFileError, GoniosimError, NewerSchemaError
from goniosim.store.layout import SCHEMA_VERSION
from goniosim.writing import StrPath

SIZE = 512
MAGIC = b"goniosim result, schema "
_HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_CHECKSUM_AT = SIZE - len("12345678\n")
_FIRST_LINE = re.compile(rb"goniosim result, schema (\d+)\.(\d+)\n")
_FIELDS = re.compile(rb"\nbytes: (\d+)\nsha256: ([0-9a-f]{64})\nattributes-sha256: ([0-9a-f]{64})\n")
REMEDY = "restore it from a copy or simulate again"


@dataclass(frozen=True)
class UserBlock:
    """What the user block says about the HDF5 part of the file."""

    schema_version: str
    length: int
    digest: str
    attributes_digest: str


def attributes_digest(attributes: Mapping[str, str | int]) -> str:
    """Digest of the root attributes, so that they can be trusted without reading the whole file.

    Parameters
    ----------
    attributes : dict of str to str or int

    Returns
    -------
    str
        SHA-256, hexadecimal.
    """
    return hashlib.sha256(json.dumps(attributes, sort_keys=True).encode()).hexdigest()


def make(image: bytes, attributes: Mapping[str, str | int]) -> bytes:
    """User block for an HDF5 image.

    Parameters
    ----------
    image : bytes
        The HDF5 part of the file.
    attributes : dict of str to str or int
        The root attributes.

    Returns
    -------
    bytes
        Exactly `SIZE` bytes.
    """
    text = (
        f"{MAGIC.decode()}{SCHEMA_VERSION}\n"
        f"An HDF5 file: its data follow this block of {SIZE} bytes. See data_schema.md of goniosim.\n"
        f"bytes: {len(image)}\n"
        f"sha256: {hashlib.sha256(image).hexdigest()}\n"
        f"attributes-sha256: {attributes_digest(attributes)}\n"
    )
    body = text.encode().ljust(_CHECKSUM_AT)
    return body + _checksum(body)


def _checksum(body: bytes) -> bytes:
    return b"%08x\n" % zlib.crc32(body)


def open_regular(path: StrPath) -> io.BufferedReader:
    """Open a file for reading, or explain why it cannot be a result.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    io.BufferedReader

    Raises
    ------
    ForeignFileError
        If the file is missing, unreadable, or not a regular file.
    """
    try:
        mode = Path(path).stat().st_mode
        if stat.S_ISDIR(mode):
            raise ForeignFileError(f"{path}: is a folder, not a goniosim result; name a file in it")
        # Opening a named pipe would wait for a writer for ever.
        if not stat.S_ISREG(mode):
            raise ForeignFileError(f"{path}: is not a regular file; copy the data into a file first")
        return open(path, "rb")
    except FileNotFoundError:
        raise ForeignFileError(f"{path}: no such file; check the path") from None
    except OSError as error:
        message = f"{path}: cannot be opened: {error.strerror}; check the permissions"
        raise ForeignFileError(message) from error


def is_result(path: StrPath) -> bool:
    """Whether an existing file starts like a result, sound or not; False if it cannot be read."""
    try:
        with open_regular(path) as stream:
            return stream.read(len(MAGIC)) == MAGIC
    except (ForeignFileError, OSError):
        return False


def read(stream: BinaryIO, path: StrPath) -> UserBlock:
    """Read the user block and hold the length of the file against it.

    Parameters
    ----------
    stream : binary file
        Positioned anywhere.
    path : path-like
        For messages.

    Returns
    -------
    UserBlock

    Raises
    ------
    ForeignFileError, DamagedFileError, NewerSchemaError
    """
    try:
        stream.seek(0)
        block = stream.read(SIZE)
        length = stream.seek(0, 2) - len(block)
    except OSError as error:
        raise DamagedFileError(f"{path}: cannot be read: {error.strerror}; {REMEDY}") from error

    if not block.startswith(MAGIC):
        raise _no_magic(block, path)
    if len(block) < SIZE:
        raise DamagedFileError(f"{path}: is cut off after {len(block)} bytes; {REMEDY}")
    body, checksum = block[:_CHECKSUM_AT], block[_CHECKSUM_AT:]
    version = _FIRST_LINE.match(body)
    if checksum != _checksum(body) or version is None:
        raise DamagedFileError(f"{path}: its first {SIZE} bytes are damaged; {REMEDY}")
    if int(version[1]) > int(SCHEMA_VERSION.split(".")[0]):
        raise NewerSchemaError(
            f"{path}: follows schema {version[1].decode()}.{version[2].decode()}, "
            f"but this goniosim reads schema {SCHEMA_VERSION}; update goniosim"
        )
    fields = _FIELDS.search(body)
    if fields is None:
        raise DamagedFileError(f"{path}: its first {SIZE} bytes lack the length or the digest; {REMEDY}")
    expected = int(fields[1])
    if length < expected:
        raise DamagedFileError(f"{path}: is cut off: {length + SIZE} of {expected + SIZE} bytes; {REMEDY}")
    if length > expected:
        raise DamagedFileError(f"{path}: has {length - expected} bytes too many; {REMEDY}")
    return UserBlock(b".".join(version.groups()).decode(), expected, fields[2].decode(), fields[3].decode())


def _no_magic(block: bytes, path: StrPath) -> GoniosimError:
    if not block:
        return ForeignFileError(f"{path}: is empty; simulate again to make a result")
    if MAGIC.startswith(block):
        return DamagedFileError(f"{path}: is cut off after {len(block)} bytes; {REMEDY}")
    kind = "an HDF5 file, but " if block.startswith(_HDF5_SIGNATURE) else ""
    return ForeignFileError(f"{path}: is {kind}not a goniosim result; name a file that `goniosim simulate` wrote")


def verify(stream: io.BufferedReader, block: UserBlock, path: StrPath) -> None:
    """Hold every byte after the user block against its digest.

    Parameters
    ----------
    stream : binary file
    block : UserBlock
    path : path-like
        For messages.

    Raises
    ------
    DamagedFileError
        If a single bit differs.
    """
    try:
        stream.seek(SIZE)
        digest = hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise DamagedFileError(f"{path}: cannot be read: {error.strerror}; {REMEDY}") from error
    if digest != block.digest:
        raise DamagedFileError(
            f"{path}: its content does not match its digest: it was damaged or edited after it was written; {REMEDY}"
        )
