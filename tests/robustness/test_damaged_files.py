"""A file that is not exactly what was written gives one clear line, and never a wrong number."""

import os
import re
import shutil
import zlib

import h5py
import pytest

from goniosim.errors import DamagedFileError, ForeignFileError, NewerSchemaError
from goniosim.store import open_result, read_header, userblock, write_result
from synthetic import make_result

MAGIC = len(userblock.MAGIC)


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """Bytes of a sound result file."""
    path = tmp_path_factory.mktemp("sound") / "sound.h5"
    write_result(make_result(orders=2), path)
    return path.read_bytes()


def refused(path, content, expected, reader=open_result):
    """The one line with which a file is refused."""
    path.write_bytes(content)
    with pytest.raises(expected) as caught:
        reader(path)
    message = str(caught.value)
    assert type(caught.value) in (expected if isinstance(expected, tuple) else (expected,))
    assert "\n" not in message and message.startswith(f"{path}: ") and "; " in message
    return message


def flipped(content, position, bit):
    """A copy with one bit turned over."""
    copy = bytearray(content)
    copy[position] ^= 1 << bit
    return bytes(copy)


def test_one_flipped_bit_in_the_user_block(tmp_path, sound):
    """Every byte of the block, each with another bit."""
    for position in range(userblock.SIZE):
        expected = ForeignFileError if position < MAGIC else DamagedFileError
        refused(tmp_path / "r.h5", flipped(sound, position, position % 8), expected)


def test_one_flipped_bit_in_the_data(tmp_path, sound):
    """Two hundred places spread over the whole file, and its very ends."""
    step = (len(sound) - userblock.SIZE) // 200
    places = [*range(userblock.SIZE, len(sound), step), len(sound) - 1]
    for number, position in enumerate(places):
        message = refused(tmp_path / "r.h5", flipped(sound, position, number % 8), DamagedFileError)
        assert "digest" in message


def test_the_header_alone_is_right_or_refused(tmp_path, sound):
    """`read_header` does not read the data: it may miss damage to them, but never misreports itself."""
    path = tmp_path / "r.h5"
    path.write_bytes(sound)
    header = read_header(path)
    caught = 0
    for position in range(0, len(sound), 97):
        path.write_bytes(flipped(sound, position, position % 8))
        try:
            assert read_header(path) == header
        except (DamagedFileError, ForeignFileError) as error:
            caught += 1
            assert "\n" not in str(error)
    assert caught > 0


def test_the_attributes_have_a_digest_of_their_own(tmp_path, sound):
    """Long texts lie outside the checksums of HDF5."""
    path = tmp_path / "r.h5"
    write_result(make_result(config_yaml="# a long comment\n" * 5000), path)
    content = path.read_bytes()
    damaged = flipped(content, content.index(b"# a long comment", userblock.SIZE) + 4, 0)
    assert "root attributes are damaged" in refused(path, damaged, DamagedFileError, read_header)


def test_truncated(tmp_path, sound):
    lengths = [1, 8, MAGIC - 1, MAGIC, MAGIC + 3, 100, 511, 512, 513, 1000, len(sound) // 2, len(sound) - 1]
    for length in lengths:
        for reader in (open_result, read_header):
            assert "is cut off" in refused(tmp_path / "r.h5", sound[:length], DamagedFileError, reader)


def test_grown(tmp_path, sound):
    assert "3 bytes too many" in refused(tmp_path / "r.h5", sound + b"abc", DamagedFileError)


def test_a_hole_of_zeros(tmp_path, sound):
    """What a file system may leave after a power cut."""
    middle = len(sound) // 2
    holed = sound[:middle] + bytes(4096) + sound[middle + 4096 :]
    refused(tmp_path / "r.h5", holed, DamagedFileError)


def test_edited_with_another_program(tmp_path, sound):
    """An honest edit is still not what was simulated."""
    path = tmp_path / "r.h5"
    path.write_bytes(sound)
    with h5py.File(path, "r+") as file:
        file["reflection/internal/energy"][0, 0, 0, 0] = 0.5
    with pytest.raises(DamagedFileError):
        open_result(path)


@pytest.mark.parametrize(
    "content",
    [b"", b"a text\n", b"\x00" * 4096, b"goniosim", b"\x89HDF\r\n\x1a\n" + bytes(600)],
    ids=["empty", "text", "zeros", "short", "hdf5-signature"],
)
def test_foreign_bytes(tmp_path, content):
    """Eight letters of our first line are the start of a result that was cut off."""
    expected = DamagedFileError if content == b"goniosim" else ForeignFileError
    for reader in (open_result, read_header):
        refused(tmp_path / "other", content, expected, reader)


def test_foreign_hdf5(tmp_path):
    path = tmp_path / "other.h5"
    with h5py.File(path, "w") as file:
        file["energy"] = [1.0]
    assert "an HDF5 file, but not a goniosim result" in refused(path, path.read_bytes(), ForeignFileError)


def test_not_a_file(tmp_path):
    """A pipe must not be waited for."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    for path, words in [
        (tmp_path, "is a folder"),
        (tmp_path / "missing.h5", "no such file"),
        (tmp_path / "missing" / "r.h5", "no such file"),
        (tmp_path / "pipe", "is not a regular file"),
        (tmp_path / "loop", "cannot be opened"),
    ]:
        with pytest.raises(ForeignFileError, match=words) as caught:
            open_result(path)
        assert "\n" not in str(caught.value)


def with_version(content, version):
    """The same file, claiming another schema version, its block in order."""
    body = re.sub(rb"schema \d+\.\d+\n", b"schema %s\n" % version, content[: userblock.SIZE - 9], count=1)
    body = body.rstrip(b" ").ljust(userblock.SIZE - 9)
    return body + b"%08x\n" % zlib.crc32(body) + content[userblock.SIZE :]


def test_newer_major_version(tmp_path, sound):
    """Recognised before anything else: not even the rest of the file is needed."""
    for version in (b"2.0", b"17.3"):
        for content in (with_version(sound, version), with_version(sound, version)[:600]):
            for reader in (open_result, read_header):
                message = refused(tmp_path / "r.h5", content, NewerSchemaError, reader)
                assert f"schema {version.decode()}" in message and "schema 1.0" in message


def test_a_damaged_version_is_not_a_newer_one(tmp_path, sound):
    assert b"schema 1.0" in sound[: MAGIC + 3]
    refused(tmp_path / "r.h5", flipped(sound, MAGIC, 1), DamagedFileError)


def sealed(path):
    """Give a file that was edited on purpose a user block that agrees with it."""
    content = path.read_bytes()
    with h5py.File(path) as file:
        attributes = {
            name: value.decode() if isinstance(value, bytes) else int(value) for name, value in file.attrs.items()
        }
    path.write_bytes(userblock.make(content[userblock.SIZE :], attributes) + content[userblock.SIZE :])


def test_newer_minor_version(tmp_path, sound):
    """It may hold more than this reader knows, and all that this reader needs."""
    path = tmp_path / "r.h5"
    path.write_bytes(sound)
    with h5py.File(path, "r+") as file:
        file["polarisation/stokes"] = [1.0, 0.5]
        file["cells/area"] = [1.0]
        file.attrs["temperature"] = 20
    sealed(path)
    path.write_bytes(with_version(path.read_bytes(), b"1.7"))
    result = open_result(path)
    assert result.name == "synthetic" and "temperature" not in result.provenance
    assert read_header(path)["temperature"] == 20


def test_older_minor_version(tmp_path, sound, monkeypatch):
    """A later goniosim of the same major version reads today's files."""
    path = tmp_path / "r.h5"
    path.write_bytes(sound)
    monkeypatch.setattr(userblock, "SCHEMA_VERSION", "1.4")
    assert open_result(path).name == "synthetic"


@pytest.mark.parametrize("path", ["transmission/energy", "audit/absorbed_media", "cells", "row", "cost"])
def test_consistent_but_incomplete(tmp_path, sound, path):
    """A file that another program sealed without a part: still one line that names it."""
    target = tmp_path / "r.h5"
    target.write_bytes(sound)
    with h5py.File(target, "r+") as file:
        del file[path]
    sealed(target)
    message = refused(target, target.read_bytes(), DamagedFileError)
    assert path.split("/")[-1] in message


def test_consistent_but_misshapen(tmp_path, sound):
    target = tmp_path / "r.h5"
    target.write_bytes(sound)
    with h5py.File(target, "r+") as file:
        del file["cells/valid"]
        file["cells/valid"] = [[[1]]]
    sealed(target)
    assert "cells/valid has shape (1, 1, 1)" in refused(target, target.read_bytes(), DamagedFileError)


def test_a_copy_is_as_good(tmp_path, sound):
    """The fixture is sound, so the refusals above are due to what was done to it."""
    (tmp_path / "a.h5").write_bytes(sound)
    shutil.copy(tmp_path / "a.h5", tmp_path / "b")
    assert open_result(tmp_path / "b").name == "synthetic"
