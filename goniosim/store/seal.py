"""The seal of a file: 512 bytes of readable text that vouch for all the rest.

It is the dataset `checksums/file`, the first that is written, so that it stands near the start of the
file and is found there without HDF5: schema, length and digests are held against the bytes before HDF5
parses any of them. Its first line and its closing checksum keep their form in every version of the schema.
"""

import hashlib
import re
import zlib
from dataclasses import dataclass
from typing import BinaryIO

from goniosim.store.kinds import Kind

SIZE = 512
# The seal lies within so many bytes from the start of the file.
WINDOW = 1 << 13
_PIECE = 1 << 20
_CHECKSUM_AT = SIZE - len("12345678\n")
_FIRST_LINE = re.compile(rb"goniosim [a-z]+, schema (\d{1,6})\.(\d{1,6})\n")
_FIELDS = re.compile(rb"\nbytes: (\d{1,18})\nsha256: ([0-9a-f]{64})\ncontent-sha256: ([0-9a-f]{64})\n")


@dataclass(frozen=True)
class Seal:
    """What the seal says.

    Attributes
    ----------
    place : int
        Where it stands in the file.
    length : int
        Bytes of the file.
    digest : str
        SHA-256 of the file without the seal, hexadecimal.
    content_digest : str
        SHA-256 of the dataset `checksums/content`, hexadecimal.
    """

    place: int
    length: int
    digest: str
    content_digest: str


def make(kind: Kind, length: int, digest: str, content_digest: str) -> bytes:
    """Text of a seal, exactly `SIZE` bytes; the arguments are the attributes of `Seal`."""
    text = (
        f"{kind.mark.decode()}{kind.schema_version}\n"
        "An HDF5 file. The digest is that of all bytes but these 512; see data_schema.md of goniosim.\n"
        f"bytes: {length}\n"
        f"sha256: {digest}\n"
        f"content-sha256: {content_digest}\n"
    )
    body = text.encode().ljust(_CHECKSUM_AT)
    return body + _checksum(body)


def version(head: bytes, place: int) -> tuple[int, int] | None:
    """Major and minor version in the first line of the seal at a place; None if it cannot be read."""
    match = _FIRST_LINE.match(head, place)
    return (int(match[1]), int(match[2])) if match else None


def find(head: bytes, mark: bytes) -> int:
    """Place of the seal that begins with ``mark``, or of what may be left of it; -1 if there is none."""
    places = [match.start() for match in re.finditer(re.escape(mark), head)]
    # A note may use the same words.
    return next((place for place in places if _is_whole(head[place : place + SIZE])), places[0] if places else -1)


def parse(head: bytes, place: int) -> Seal | None:
    """Read the seal at a place; None if it is cut off or was altered."""
    block = head[place : place + SIZE]
    fields = _FIELDS.search(block)
    if not _is_whole(block) or fields is None:
        return None
    return Seal(place, int(fields[1]), fields[2].decode(), fields[3].decode())


def digest(stream: BinaryIO, place: int) -> str:
    """SHA-256 of a file without the seal at a place, hexadecimal."""
    stream.seek(0)
    found = hashlib.sha256(stream.read(place))
    stream.seek(place + SIZE)
    while piece := stream.read(_PIECE):
        found.update(piece)
    return found.hexdigest()


def _is_whole(block: bytes) -> bool:
    body, checksum = block[:_CHECKSUM_AT], block[_CHECKSUM_AT:]
    return len(block) == SIZE and checksum == _checksum(body)


def _checksum(body: bytes) -> bytes:
    return b"%08x\n" % zlib.crc32(body)
