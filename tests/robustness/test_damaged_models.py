"""A file of integrated models that is not what was written gives one clear line, and never a wrong number."""

import hashlib
import re
import warnings

import h5py
import numpy as np
import pytest

from crafting import craft
from goniosim.errors import AnnotatedFileWarning, DamagedFileError, ForeignFileError, GoniosimError, NewerSchemaError
from goniosim.store import open_models
from synthetic import write_models


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """Bytes of a sound file."""
    path = tmp_path_factory.mktemp("sound") / "models.h5"
    write_models(path, components=("reflection/direct", "reflection/internal"), theta_deg=(20.0,), rows=2, columns=4)
    return path.read_bytes()


@pytest.fixture
def path(tmp_path, sound):
    """A sound file, to be spoilt."""
    (tmp_path / "models.h5").write_bytes(sound)
    return tmp_path / "models.h5"


def content(path):
    """Everything that a file says, as one digest."""
    digest = hashlib.sha256()
    with open_models(path) as models:
        digest.update(repr(sorted(models.provenance.items())).encode())
        for name in models.materials:
            material = models.material(name)
            digest.update(repr([material.config_yaml, material.main_component, material.models]).encode())
            for array in (material.theta_deg, material.rays, *vars(material.cells).values()):
                digest.update(np.asarray(array).tobytes() if not isinstance(array, str) else array.encode())
            for entry in material.models:
                for component in models.slices(material, entry).values():
                    for each in ("energy", "stderr", "bsdf", "bsdf_stderr"):
                        digest.update(getattr(component, each).tobytes())
    return digest.hexdigest()


def refused(path, raw, expected):
    """The one line with which a file is refused."""
    path.write_bytes(raw)
    with pytest.raises(expected) as caught:
        content(path)
    message = str(caught.value)
    assert type(caught.value) is expected
    assert "\n" not in message and message.startswith(f"{path}: ") and "; " in message
    return message


def outcomes(path, positions):
    """What becomes of a file with one flipped bit, at each position."""
    right, raw = content(path), path.read_bytes()
    found = set()
    for number, position in enumerate(positions):
        copy = bytearray(raw)
        copy[position] ^= 1 << (number + position) % 8
        path.write_bytes(copy)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            try:
                assert content(path) == right, position
                assert [each.category for each in told] == [AnnotatedFileWarning], position
                found.add("annotated")
            except GoniosimError as error:
                assert "\n" not in str(error) and type(error) is DamagedFileError
                found.add("damaged")
    return found


def test_a_flipped_bit_is_damage_or_lies_in_the_slack(path, sound):
    """Some fifty places spread over the whole file; `-m slow` takes every thirteenth byte."""
    assert outcomes(path, range(8, len(sound), len(sound) // 50)) == {"annotated", "damaged"}


@pytest.mark.slow
def test_a_flipped_bit_in_every_thirteenth_byte_is_damage_or_lies_in_the_slack(path, sound):
    assert outcomes(path, range(8, len(sound), 13)) == {"annotated", "damaged"}


def test_truncated(tmp_path, sound):
    for length in (2600, 5000, len(sound) // 2, len(sound) - 1):
        message = refused(tmp_path / "models.h5", sound[:length], DamagedFileError)
        assert f"is cut off: {length} of {len(sound)} bytes" in message
    for length in (0, 7, 100):
        refused(tmp_path / "models.h5", sound[:length], ForeignFileError)


def test_what_a_user_adds_damages_nothing(path):
    right = content(path)
    with h5py.File(path, "r+") as file:
        file.attrs["note"] = "mine"
        file["notes/temperature"] = [20.0]
        file["synthetic/comments"] = [1.0]
        file["synthetic/ww09"].attrs["note"] = 1
        file["synthetic/ww09/reflection/internal/weights"] = [1.0]
        file["synthetic/ww09/transmission/energy"] = [1.0]
        file.create_group("other").attrs["config_hash"] = "1"
    with pytest.warns(AnnotatedFileWarning, match="annotated"):
        assert content(path) == right


@pytest.mark.parametrize(
    ("edit", "what"),
    [
        (lambda file: file["synthetic/ww09/reflection/direct/bsdf"].__setitem__((0, 0, 0, 0), 0.5), "direct/bsdf"),
        (lambda file: file["synthetic"].attrs.__setitem__("config_yaml", np.bytes_("x")), "synthetic"),
        (lambda file: file["synthetic/ww09"].attrs.__setitem__("options", np.bytes_("x=1")), "ww09"),
        (lambda file: file.__delitem__("synthetic/ww09/cells/valid"), "ww09/cells/valid"),
    ],
)
def test_what_a_user_changes_is_damage(path, edit, what):
    with h5py.File(path, "r+") as file:
        edit(file)
    assert what in refused(path, path.read_bytes(), DamagedFileError)


@pytest.mark.parametrize("error", [ValueError("mine"), OSError(28, "No space left"), RuntimeError("mine")])
def test_what_goes_wrong_while_a_file_is_open_is_no_damage(path, error):
    with pytest.raises(type(error)) as caught, open_models(path):
        raise error
    assert caught.value is error


@pytest.mark.parametrize("version", ["2.0", "17.3"])
def test_newer_major_version(path, version):
    craft(path, version=version)
    for raw in (path.read_bytes(), path.read_bytes()[:4000]):
        message = refused(path, raw, NewerSchemaError)
        assert f"schema {version}" in message and "update goniosim" in message


def test_newer_minor_version(path):
    """It may hold more than this reader knows."""

    def edit(file):
        file.attrs["schema_version"] = np.bytes_("1.9")
        file["synthetic/ww09/polarisation/stokes"] = [1.0]

    craft(path, edit, version="1.9")
    with open_models(path) as models:
        assert models.schema_version == "1.9" and len(models.material("synthetic").models) == 2


def test_a_scene_that_only_a_newer_goniosim_knows_is_no_damage(path):
    def edit(file):
        file.attrs["schema_version"] = np.bytes_("1.9")
        scene = file["synthetic"].attrs["config_yaml"] + b"polarisation: true\n"
        file["synthetic"].attrs.create("config_yaml", scene, dtype=f"S{len(scene)}")

    craft(path, edit, version="1.9")
    with open_models(path) as models, pytest.raises(NewerSchemaError, match="update goniosim"):
        models.material("synthetic")


def set_attribute(where, name, value):
    return lambda file: file[where].attrs.__setitem__(name, value)


def rename_model(name, options=""):
    """A model under another name, in accord with itself."""

    def edit(file):
        label = f"{name}[{options}]" if options else name
        file["synthetic"].move("ww09", label)
        file["synthetic"][label].attrs["model"] = np.bytes_(name)
        file["synthetic"][label].attrs["options"] = np.bytes_(options)
        file["synthetic"].attrs["models"] = np.bytes_(label)

    return edit


def values_of(path, edit):
    def change(file):
        dataset = file[path]
        dataset[...] = edit(dataset[...])

    return change


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (lambda file: file.__delitem__("synthetic"), "synthetic is missing"),
        (lambda file: file.__delitem__("synthetic/ww09"), "ww09 is missing"),
        (lambda file: file.__delitem__("synthetic/cells/valid"), "cells/valid is missing"),
        (lambda file: file.__delitem__("synthetic/ww09/reflection/internal/bsdf"), "internal/bsdf is missing"),
        (lambda file: file.__delitem__("synthetic/ww09/reflection"), "has no component"),
        (lambda file: file.attrs.__delitem__("materials"), "the attribute materials of / is missing"),
        (lambda file: file.attrs.__delitem__("schema_version"), "schema_version"),
        (lambda file: file["synthetic"].attrs.__delitem__("main_component"), "main_component"),
        (set_attribute("synthetic", "config_yaml", np.bytes_("x")), "config_yaml"),
        (set_attribute("synthetic", "name", np.bytes_("other")), "calls itself 'other'"),
        (set_attribute("/", "materials", np.bytes_("a/b")), "lists 'a/b'"),
        (set_attribute("/", "materials", np.bytes_("..")), ".. is missing"),
        (set_attribute("synthetic", "main_component", np.bytes_("transmission")), "main_component must be one of"),
        (set_attribute("synthetic", "main_component", np.bytes_("banana")), "main_component is 'banana'"),
        (rename_model("a/../b"), "lists 'a/../b'|is missing"),
        (rename_model("..\x1b[2J"), "a model must be called"),
        (rename_model("ww09", "x=\x1b]0;"), "a model must be called"),
        (values_of("synthetic/ww09/reflection/internal/bsdf", lambda values: values * np.nan), "must be finite"),
        (values_of("synthetic/ww09/reflection/internal/bsdf", lambda values: values - 1e9), "must be finite and 0"),
        (values_of("synthetic/incident/theta_deg", lambda values: values + 80), "theta_deg must be from 0 to below 90"),
    ],
)
def test_signed_but_senseless(path, edit, words):
    craft(path, edit)
    assert re.search(words, refused(path, path.read_bytes(), DamagedFileError))


def test_signed_but_misshapen(path):
    def edit(file):
        del file["synthetic/ww09/reflection/internal/bsdf"]
        file["synthetic/ww09/reflection/internal/bsdf"] = [[[1.0]]]

    craft(path, edit)
    assert "has shape (1, 1, 1)" in refused(path, path.read_bytes(), DamagedFileError)
