"""A file of integrated models holds what was put in, gives it back piece by piece, and destroys nothing."""

import gzip
from pathlib import Path

import h5py
import numpy as np
import pytest

from goniosim.errors import DamagedFileError, ForeignFileError, OutputError, UnusableResultError
from goniosim.store import (
    ModelsWriter,
    access,
    is_models_file,
    may_be_models_file,
    open_models,
    open_result,
    write_result,
)
from goniosim.store.checksums import fletcher32
from goniosim.store.models.layout import describe
from synthetic import MODELS, make_result, write_models

# Internal albedo of ww09 at normal incidence in the old file, as goniosim 0.1 reads it.
OLD_ALBEDO = [0.087707513, 0.070192222, 0.045091582]
PROVENANCE = {"created_utc": "2024-05-01T12:00:00Z", "goniosim_version": "0.1.0"}


def test_what_goes_in_comes_out(tmp_path):
    """In the order in which it went in, to 24 significant bits."""
    names = ("zinc", "amber")
    written = write_models(tmp_path / "models.h5", names, parametrization="half")
    with open_models(tmp_path / "models.h5") as models:
        assert models.materials == names
        assert models.provenance["subcells"] == "5" and "filetype" not in models.provenance
        for name in names:
            material = models.material(name)
            result = written[name, "ww09"]
            assert material.config_yaml == make_result(name=name, parametrization="half").config_yaml
            assert material.config_hash == result.config_hash
            assert material.main_component == "transmission" and material.channels == result.channels
            np.testing.assert_array_equal(material.theta_deg, result.theta_deg)
            np.testing.assert_array_equal(material.cells.valid, result.cells.valid)
            assert material.cells.parametrization == "half"
            assert [entry.label for entry in material.models] == list(MODELS)
            for entry in material.models:
                assert {"model": entry.model, "options": entry.options} == MODELS[entry.label]
                slices = models.slices(material, entry)
                expected = written[name, entry.label].components
                assert slices.keys() == entry.components.keys() == expected.keys()
                for path, component in slices.items():
                    assert component.contains_delta == expected[path].contains_delta
                    for each in ("energy", "stderr", "bsdf", "bsdf_stderr"):
                        np.testing.assert_allclose(
                            getattr(component, each), getattr(expected[path], each), rtol=2.0**-24, atol=0.0
                        )


def test_only_what_is_asked_for_is_read(tmp_path, monkeypatch):
    """A study of a gigabyte is opened and described without its slices."""
    write_models(tmp_path / "models.h5", ("a", "b"))
    read = []
    original = access.read
    monkeypatch.setattr(access, "read", lambda dataset: (read.append(dataset.name), original(dataset))[1])
    with open_models(tmp_path / "models.h5") as models:
        described = [models.material(name) for name in models.materials]
        assert not any(name.endswith("/energy") for name in read)
        read.clear()
        models.slices(described[1], described[1].models[0])
    assert read and all(name.startswith("/b/ww09/") for name in read)


def test_equal_components_are_stored_once_but_never_one_that_holds_others(tmp_path):
    """`reflection` as such is the parent of `reflection/internal`, which a link would bring along."""
    result = make_result(components=("reflection/direct", "reflection/internal"))
    direct, internal = result.components.values()
    writer = ModelsWriter(tmp_path / "models.h5", PROVENANCE)
    writer.add_material(result, "reflection")
    writer.add_model(result, "ww09", {"model": "ww09", "options": ""}, result.components)
    split = {"reflection": direct, "reflection/internal": internal}
    writer.add_model(result, "elek10", {"model": "elek10", "options": ""}, split)
    writer.add_model(result, "bati19_ww", {"model": "bati19_ww", "options": ""}, {"reflection": direct})
    writer.commit()
    with open_models(tmp_path / "models.h5") as models:
        found = {entry.label: set(entry.components) for entry in models.material("synthetic").models}
    assert found == {
        "ww09": {"reflection/direct", "reflection/internal"},
        "elek10": {"reflection", "reflection/internal"},
        "bati19_ww": {"reflection"},
    }
    with h5py.File(tmp_path / "models.h5") as file:
        shared = [file[f"synthetic/{label}/reflection/internal/energy"] for label in ("ww09", "elek10")]
        assert shared[0] == shared[1]


def test_a_material_without_models_is_no_error(tmp_path):
    result = make_result()
    writer = ModelsWriter(tmp_path / "models.h5", PROVENANCE)
    writer.add_material(result, "transmission")
    writer.commit()
    with open_models(tmp_path / "models.h5") as models:
        assert models.material("synthetic").models == ()


def test_schema_1_1_is_still_read(tmp_path):
    """A file that goniosim 0.1 wrote; what a user adds to one is ignored without a word."""
    path = tmp_path / "models.h5"
    path.write_bytes(gzip.decompress((Path(__file__).parents[1] / "data" / "models-1.1.h5.gz").read_bytes()))
    with h5py.File(path, "r+") as file:
        file.attrs["note"] = "mine"
        file["patina/comments"] = [1.0]
    with open_models(path) as models:
        assert (models.schema_version, models.materials, models.provenance["subcells"]) == ("1.1", ("patina",), "2")
        material = models.material("patina")
        assert material.main_component == "reflection/internal" and material.cells.valid.shape == (2, 4, 8)
        (entry,) = material.models
        slices = models.slices(material, entry)
    assert list(slices) == ["reflection/direct", "reflection/internal"]
    assert slices["reflection/internal"].energy.sum(axis=(2, 3))[0] == pytest.approx(OLD_ALBEDO, rel=1e-6)


def test_a_flipped_bit_in_schema_1_1_is_an_error(tmp_path):
    """Forty places in the chunks of slices, where HDF5 has a checksum, and one in the scene, where it has none."""
    path = tmp_path / "models.h5"
    sound = gzip.decompress((Path(__file__).parents[1] / "data" / "models-1.1.h5.gz").read_bytes())
    path.write_bytes(sound)
    with h5py.File(path) as file:
        dataset = file["patina/ww09/reflection/internal/energy"].id
        chunks = [dataset.get_chunk_info(number) for number in range(dataset.get_num_chunks())]
    places = [chunk.byte_offset + chunk.size * part // 7 for chunk in chunks for part in range(7)]
    for number, place in enumerate([*places, sound.index(b"material:") + 40]):
        copy = bytearray(sound)
        copy[place] ^= 1 << number % 8
        path.write_bytes(copy)
        with pytest.raises(DamagedFileError), open_models(path) as models:
            models.material("patina")


def test_schema_1_0_is_still_read(tmp_path):
    """It had no lists, no digest of the scene and no main component."""
    path = tmp_path / "models.h5"
    path.write_bytes(gzip.decompress((Path(__file__).parents[1] / "data" / "models-1.1.h5.gz").read_bytes()))
    with h5py.File(path, "r+") as file:
        del file.attrs["materials"], file.attrs["schema_version"]
        file.attrs["schema_version"] = np.bytes_("1.0")
        for name in ("models", "main_component", "config_yaml_sha256"):
            del file["patina"].attrs[name]
    with open_models(path) as models:
        material = models.material("patina")
        assert material.main_component == "reflection/internal"
        assert [entry.label for entry in material.models] == ["ww09"]


def test_the_two_kinds_of_file_are_told_apart(tmp_path):
    write_models(tmp_path / "models.h5")
    write_result(make_result(), tmp_path / "result.h5")
    (tmp_path / "text.h5").write_text("text")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["energy"] = [1.0]
    (tmp_path / "cut.h5").write_bytes((tmp_path / "models.h5").read_bytes()[:5000])
    kinds = {"models": (True, True), "cut": (False, True)}
    for name in ("models", "result", "text", "other", "cut", "missing"):
        path = tmp_path / f"{name}.h5"
        assert (is_models_file(path), may_be_models_file(path)) == kinds.get(name, (False, False)), name
    for name in ("result", "text", "other", "missing"):
        with pytest.raises(ForeignFileError), open_models(tmp_path / f"{name}.h5"):
            pass
    with pytest.raises(UnusableResultError, match="integrated models.*open_models") as caught:
        open_result(tmp_path / "models.h5")
    assert "\n" not in str(caught.value)


def test_only_a_file_of_its_kind_is_replaced(tmp_path):
    write_models(tmp_path / "models.h5", ("first",))
    write_models(tmp_path / "models.h5", ("second",))
    with open_models(tmp_path / "models.h5") as models:
        assert models.materials == ("second",)
    write_result(make_result(name="precious"), tmp_path / "result.h5")
    with pytest.raises(OutputError, match="result.h5: exists and is not a file of integrated models"):
        write_models(tmp_path / "result.h5")
    assert open_result(tmp_path / "result.h5").name == "precious"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["models.h5", "result.h5"]


def test_nothing_is_left_of_a_file_that_was_not_committed(tmp_path):
    write_models(tmp_path / "models.h5", ("first",))
    writer = ModelsWriter(tmp_path / "models.h5", PROVENANCE)
    writer.add_material(make_result(), "transmission")
    writer.discard()
    writer.discard()
    assert [path.name for path in tmp_path.iterdir()] == ["models.h5"]
    with pytest.raises(OutputError, match="cannot be written"):
        ModelsWriter(tmp_path / "missing" / "models.h5", PROVENANCE)


@pytest.mark.parametrize("length", [0, 1, 2, 7, 4096, 300_001])
def test_the_checksum_is_that_of_hdf5(tmp_path, length):
    """HDF5 appends it to each chunk; two ways in which HDF5 may write 0 are one to us."""
    values = np.random.default_rng(length).integers(0, 256, max(length, 1), dtype=np.uint8)
    if length == 0:
        values[:] = 0
    with h5py.File(tmp_path / "file.h5", "w") as file:
        dataset = file.create_dataset("values", data=values, chunks=values.shape, fletcher32=True)
        _, raw = dataset.id.read_direct_chunk((0,))
    stored = int.from_bytes(raw[-4:], "little")
    assert bytes(values) == raw[:-4]
    assert fletcher32(raw[:-4]) == ((stored & 0xFFFF) % 65535, (stored >> 16) % 65535)


def test_only_the_components_of_the_schema_are_described():
    assert describe("reflection/energy").dims == ("direction", "channel", "row", "column")
    for unknown in ("reflection/hits", "audit/absorbed_base", "transmission/order_2/energy"):
        with pytest.raises(KeyError, match="no dataset"):
            describe(unknown)
