"""A file that is not exactly what was written gives one clear line, and never a wrong number."""

import gzip
import os
import shutil
import warnings
from pathlib import Path

import h5py
import numpy as np
import pytest

from crafting import craft
from goniosim.errors import (
    AnnotatedFileWarning,
    DamagedFileError,
    ForeignFileError,
    GoniosimError,
    NewerSchemaError,
    OutputError,
)
from goniosim.store import legacy, open_result, read_header, reserve_output, seal, write_result
from goniosim.store.kinds import RESULT
from synthetic import make_result

DATA = Path(__file__).parents[1] / "data"
# Internal albedo at normal incidence of the old file, as goniosim 0.1 reads it.
OLD_ALBEDO = [0.054506873407222795, 0.043675025096942606, 0.028271632608761636]


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """Bytes of a sound result file."""
    path = tmp_path_factory.mktemp("sound") / "sound.h5"
    write_result(make_result((20.0,), rows=2, columns=4), path)
    return path.read_bytes()


@pytest.fixture
def path(tmp_path, sound):
    """A sound result file, to be spoilt."""
    (tmp_path / "r.h5").write_bytes(sound)
    return tmp_path / "r.h5"


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


def outcome(path, right):
    """``damaged`` or ``annotated``: whatever else happens to a file with a flipped bit fails the test."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        try:
            found = open_result(path)
        except GoniosimError as error:
            assert "\n" not in str(error) and type(error) is DamagedFileError, error
            return "damaged"
    assert [each.category for each in told] == [AnnotatedFileWarning] and "something was added" in str(told[0].message)
    assert vars(found).keys() == vars(right).keys() and repr(found) == repr(right)
    for name, component in found.components.items():
        for each in ("energy", "stderr", "bsdf", "bsdf_stderr"):
            np.testing.assert_array_equal(getattr(component, each), getattr(right.components[name], each))
    return "annotated"


def outcomes(path, content, positions):
    path.write_bytes(content)
    right = open_result(path)
    found = []
    for number, position in enumerate(positions):
        path.write_bytes(flipped(content, position, (number + position) % 8))
        found.append(outcome(path, right))
    return found


def test_a_flipped_bit_is_damage_or_lies_in_the_slack(tmp_path, sound):
    """Eighty places spread over the whole file, its start, and its very end; `-m slow` takes every thirteenth byte."""
    places = [*range(8, 60, 3), *range(60, len(sound), len(sound) // 60), len(sound) - 1]
    found = outcomes(tmp_path / "r.h5", sound, places)
    assert "damaged" in found and "annotated" in found


@pytest.mark.slow
def test_a_flipped_bit_in_every_thirteenth_byte_is_damage_or_lies_in_the_slack(tmp_path, sound):
    outcomes(tmp_path / "r.h5", sound, range(8, len(sound), 13))


def test_the_signature_itself_may_be_damaged(tmp_path, sound):
    """The seal still tells what the file was."""
    for position in range(8):
        refused(tmp_path / "r.h5", flipped(sound, position, position), DamagedFileError)


def test_every_flipped_bit_of_the_seal_is_damage(tmp_path, sound):
    place = sound.find(RESULT.mark)
    for position in range(place, place + seal.SIZE, 7):
        refused(tmp_path / "r.h5", flipped(sound, position, position % 8), DamagedFileError)


def test_the_header_alone_is_right_or_refused(path, sound):
    """`read_header` does not read the data: it may miss damage to them, but never misreports itself."""
    header = read_header(path)
    caught = 0
    for position in range(0, len(sound), len(sound) // 80):
        path.write_bytes(flipped(sound, position, position % 8))
        try:
            assert read_header(path) == header
        except (DamagedFileError, ForeignFileError) as error:
            caught += 1
            assert "\n" not in str(error)
    assert caught > 0


def test_a_long_text_lies_outside_the_checksums_of_hdf5(path):
    long = make_result()
    long.provenance["command"] = "a long command " * 5000
    write_result(long, path, overwrite=True)
    content = path.read_bytes()
    damaged = flipped(content, content.index(b"a long command") + 4, 0)
    for reader in (open_result, read_header):
        assert "attribute of the root was changed" in refused(path, damaged, DamagedFileError, reader)


def test_the_header_is_read_without_the_data(path, monkeypatch):
    monkeypatch.setattr(seal, "digest", lambda *_: pytest.fail("reads the whole file"))
    assert read_header(path)["name"] == "synthetic"


def test_truncated(tmp_path, sound):
    """From the seal on, the numbers of bytes are known; before it there is nothing to know the file by."""
    place = sound.find(RESULT.mark)
    for length in (place + 60, place + seal.SIZE - 1, place + seal.SIZE, 4000, len(sound) // 2, len(sound) - 1):
        for reader in (open_result, read_header):
            message = refused(tmp_path / "r.h5", sound[:length], DamagedFileError, reader)
            assert "is cut off" in message and f" {length} " in message
    assert f"{len(sound) - 1} of {len(sound)} bytes" in message
    for length in (1, 8, 100):
        refused(tmp_path / "r.h5", sound[:length], ForeignFileError)


def test_a_hole_of_zeros(tmp_path, sound):
    """What a file system may leave after a power cut."""
    for start in range(2048, len(sound), len(sound) // 10):
        refused(tmp_path / "r.h5", sound[:start] + bytes(4096) + sound[start + 4096 :], DamagedFileError)


def annotate(file):
    file.attrs["note"] = "goniosim result, schema 9.0\n is not yet out"
    file["reflection"].attrs["note"] = ["of", "several", "words"]
    file["effects"].attrs["weather"] = 3
    file["reflection/internal/energy"].attrs["note"] = 1.5
    file["polarisation/stokes"] = np.ones((100, 100))
    file["cells/area"] = [1.0]
    file["reflection/internal/order_2/energy"] = [1.0]
    file["reflection/direct/hits"] = [1.0]
    file["elsewhere"] = h5py.ExternalLink("/etc/passwd", "/")
    file["reflection/round"] = file["reflection"]


def test_what_a_user_adds_damages_nothing(path, sound):
    right = open_result(path)
    with h5py.File(path, "r+") as file:
        annotate(file)
    assert outcome(path, right) == "annotated"
    assert read_header(path)["status"] == "complete"
    path.write_bytes(sound + b"abc")
    assert outcome(path, right) == "annotated"
    with h5py.File(path, "r+") as file:
        annotate(file)
        del file["polarisation"], file.attrs["note"]
    assert outcome(path, right) == "annotated"


def set_attribute(where, name, value):
    return lambda file: file[where].attrs.__setitem__(name, value)


@pytest.mark.parametrize(
    ("edit", "what"),
    [
        (lambda file: file["reflection/internal/energy"].__setitem__((0, 0, 0, 0), 0.5), "reflection/internal/energy"),
        (lambda file: file["row"].__setitem__(0, 0.5), "row"),
        (set_attribute("/", "name", "gold"), "root"),
        (set_attribute("/", "seed", 2), "root"),
        (set_attribute("/", "processor", np.bytes_("abacus")), "root"),
        (set_attribute("row", "units", np.bytes_("rad")), "row"),
        (set_attribute("transmission", "contains_delta", np.int8(0)), "transmission"),
        (lambda file: file["effects"].attrs.__delitem__("orders"), "orders"),
        (lambda file: file.__delitem__("audit/absorbed_media"), "audit/absorbed_media"),
        (lambda file: file.__delitem__("cells/row"), "cells/row"),
        (lambda file: file.move("row", "line"), "row"),
        (lambda file: file.__delitem__("checksums"), "checksums"),
    ],
)
def test_what_a_user_changes_is_damage(path, edit, what):
    with h5py.File(path, "r+") as file:
        edit(file)
    assert what in refused(path, path.read_bytes(), DamagedFileError)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"a text\n",
        b"\x00" * 4096,
        b"\x89HDF\r\n\x1a\n" + bytes(600),
        (Path(__file__).parents[2] / "data_schema.md").read_bytes(),
        bytes(512) + b"goniosim result, schema 1.3\n" + bytes(512),
    ],
    ids=["empty", "text", "zeros", "hdf5-signature", "document", "archive"],
)
def test_foreign_bytes(tmp_path, content):
    for reader in (open_result, read_header):
        refused(tmp_path / "other", content, ForeignFileError, reader)


def test_foreign_hdf5(tmp_path, path):
    """Also one into which a result was copied."""
    other = tmp_path / "other.h5"
    with h5py.File(other, "w") as file:
        file["energy"] = [1.0]
    assert "an HDF5 file, but not a goniosim result" in refused(other, other.read_bytes(), ForeignFileError)
    with h5py.File(other, "w") as file, h5py.File(path) as result:
        result.copy("/", file, "gold")
    refused(other, other.read_bytes(), ForeignFileError)


def test_what_is_overwritten_is_a_result_sound_or_not(tmp_path, sound):
    """A collection into which results were copied, or a text about them, is none."""
    path, result = tmp_path / "r.h5", make_result((20.0,), rows=2, columns=4)
    for position in (40, 2100, len(sound) // 2):
        path.write_bytes(flipped(sound, position, 3))
        write_result(result, path)
        assert path.read_bytes() == sound
    with h5py.File(tmp_path / "all.h5", "w") as file, h5py.File(path) as one:
        one.copy("/", file, "gold")
    collection = (tmp_path / "all.h5").read_bytes()
    for content in (collection, b"text", (Path(__file__).parents[2] / "data_schema.md").read_bytes(), bytes(9000)):
        path.write_bytes(content)
        with pytest.raises(OutputError, match="is not overwritten"):
            reserve_output(path, 0)
        assert path.read_bytes() == content


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
        (tmp_path / ("n" * 300), "cannot be opened"),
        (f"{tmp_path}/a\0b", "cannot be opened"),
    ]:
        with pytest.raises(ForeignFileError, match=words) as caught:
            open_result(path)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize("version", ["2.0", "17.3"])
def test_newer_major_version(path, version):
    """Recognised before anything else: not even the rest of the file is needed."""
    craft(path, version=version)
    content = path.read_bytes()
    for each in (content, content[:4000]):
        for reader in (open_result, read_header):
            message = refused(path, each, NewerSchemaError, reader)
            assert f"schema {version}" in message and "schema 1.4" in message


def test_newer_minor_version(path):
    """It may hold more than this reader knows, and all that this reader needs."""

    def edit(file):
        file["polarisation/stokes"] = [1.0, 0.5]
        file.attrs["temperature"] = np.int64(20)

    craft(path, edit, version="1.7")
    result = open_result(path)
    assert result.name == "synthetic" and "temperature" not in result.provenance
    assert read_header(path)["temperature"] == 20


@pytest.mark.parametrize(("version", "error"), [("1.4", DamagedFileError), ("1.7", NewerSchemaError)])
def test_a_scene_that_only_a_newer_goniosim_knows_is_no_damage(path, version, error):
    def edit(file):
        file.attrs["schema_version"] = np.bytes_(version)
        scene = file.attrs["config_yaml"] + b"polarisation: true\n"
        file.attrs.create("config_yaml", scene, dtype=f"S{len(scene)}")

    craft(path, edit, version=version)
    message = refused(path, path.read_bytes(), error)
    assert ("update goniosim" in message) == (version == "1.7")


def test_schema_1_0_is_still_read(tmp_path):
    """A file that goniosim 0.1 wrote; its numbers are as they were."""
    path = tmp_path / "old.h5"
    content = gzip.decompress((DATA / "result-1.0.h5.gz").read_bytes())
    path.write_bytes(content)
    result = open_result(path)
    assert (result.name, result.status, result.seed) == ("patina", "complete", 7)
    assert list(result.components) == ["reflection/direct", "reflection/internal"]
    assert result.theta_deg.tolist() == [0.0, 50.0] and result.rays.tolist() == [10_000, 10_000]
    albedo = result.components["reflection/internal"].energy.sum(axis=(2, 3))
    assert read_header(path)["schema_version"] == "1.0"
    np.testing.assert_allclose(albedo, result.audit.energy["reflected_internal"], rtol=1e-12)
    np.testing.assert_allclose(albedo[0], OLD_ALBEDO, rtol=1e-12)
    for position in [*range(30, legacy.SIZE, 9), *range(legacy.SIZE, len(content), len(content) // 50)]:
        assert refused(path, flipped(content, position, position % 8), DamagedFileError)
    for length in (8, 100, 512, 5000, len(content) - 1):
        for reader in (open_result, read_header):
            assert "is cut off" in refused(path, content[:length], DamagedFileError, reader)
    newer = b"goniosim result, schema 2.0" + content[27:]
    refused(path, newer, NewerSchemaError)


def test_schema_1_1_is_still_read(tmp_path):
    """Its one cost for all directions is shared out; albedos were in the audit; the rest follows from what it holds."""
    path = tmp_path / "old.h5"
    path.write_bytes(gzip.decompress((DATA / "result-1.1.h5.gz").read_bytes()))
    result = open_result(path)
    assert read_header(path)["schema_version"] == "1.1" and result.estimator == "analog"
    internal, direct = result.components["reflection/internal"], result.components["reflection/direct"]
    np.testing.assert_allclose(internal.albedo[0], OLD_ALBEDO, rtol=1e-12)
    np.testing.assert_array_equal(result.albedo("reflection/internal")[1], result.audit.stderr["reflected_internal"])
    np.testing.assert_array_equal(direct.albedo, result.audit.direct_integrated)
    assert direct.estimator == ["integrated", "integrated"] and direct.uncertain is None and direct.hits is None
    (order,) = internal.orders.values()
    for part in (internal, order):
        assert part.uncertain.shape == part.energy.shape and part.batches is None and part.node_bias is None
        # Three hits are too few; of thousands of hits ten count.
        hits = np.broadcast_to(part.hits[:, None], part.energy.shape)
        assert part.uncertain[hits < 10].all() and not part.uncertain[hits > 100].any()
    # The order is all there is: its error, from cells, is that of the audit but for the scatter of parts.
    np.testing.assert_allclose(order.albedo_stderr, internal.albedo_stderr, rtol=4.0 / (2 * 63) ** 0.5)
    cost = result.cost
    assert cost.rays.tolist() == [[625, 1250, 2500, 5000, 10_000]] * 2
    assert cost.elapsed[-1] == pytest.approx(2.0 * cost.seconds[0, -1]) and (cost.seconds[0] == cost.seconds[1]).all()
    assert cost.noise("reflection/internal")[-1] == pytest.approx(0.00173277, rel=1e-5)
    write_result(result, tmp_path / "new.h5")
    assert read_header(tmp_path / "new.h5")["schema_version"] == "1.4"
    np.testing.assert_array_equal(open_result(tmp_path / "new.h5").cost.seconds, cost.seconds)


def test_a_copy_is_as_good(tmp_path, path):
    """The fixture is sound, so the refusals above are due to what was done to it."""
    shutil.copy(path, tmp_path / "b")
    assert open_result(tmp_path / "b").name == "synthetic"
