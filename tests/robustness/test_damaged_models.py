"""A file of integrated models that is not what was written gives one clear line, and never a wrong number."""

import hashlib
import re

import h5py
import numpy as np
import pytest

from goniosim.errors import DamagedFileError, ForeignFileError, GoniosimError, NewerSchemaError
from goniosim.store import open_models
from synthetic import write_models


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """Bytes of a sound file."""
    path = tmp_path_factory.mktemp("sound") / "models.h5"
    write_models(path, components=("reflection/direct", "reflection/internal"))
    return path.read_bytes()


def content(path, verify):
    """Everything that a file says, as one digest."""
    digest = hashlib.sha256()
    with open_models(path) as models:
        if verify:
            models.verify()
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
        content(path, verify=False)
    message = str(caught.value)
    assert type(caught.value) is expected
    assert "\n" not in message and message.startswith(f"{path}: ") and "; " in message
    return message


def edited(path, raw, edit):
    """The bytes of a file after an edit with another program."""
    path.write_bytes(raw)
    with h5py.File(path, "r+") as file:
        edit(file)
    return path.read_bytes()


@pytest.mark.parametrize("verify", [False, True])
def test_a_flipped_bit_is_an_error_or_without_effect(tmp_path, sound, verify):
    """Some 150 places spread over the whole file; much of a small file is slack that nobody reads."""
    path = tmp_path / "models.h5"
    path.write_bytes(sound)
    right = content(path, verify)
    caught = 0
    for number, position in enumerate(range(0, len(sound), len(sound) // 150)):
        copy = bytearray(sound)
        copy[position] ^= 1 << number % 8
        path.write_bytes(copy)
        try:
            assert content(path, verify) == right, position
        except GoniosimError as error:
            caught += 1
            assert "\n" not in str(error)
    assert caught > 20


def test_every_flipped_bit_of_the_slices_is_found_without_reading_them(tmp_path, sound):
    path = tmp_path / "models.h5"
    path.write_bytes(sound)
    with h5py.File(path) as file:
        dataset = file["synthetic/ww09/reflection/internal/energy"]
        chunks = [dataset.id.get_chunk_info(number) for number in range(dataset.id.get_num_chunks())]
    for number, chunk in enumerate(chunks):
        copy = bytearray(sound)
        copy[chunk.byte_offset + number * (chunk.size - 1) // max(1, len(chunks) - 1)] ^= 1 << number % 8
        path.write_bytes(copy)
        with open_models(path) as models:
            models.material("synthetic")
            with pytest.raises(DamagedFileError, match="ww09/reflection/internal/energy does not match its checksums"):
                models.verify()


def test_truncated(tmp_path, sound):
    for length in (8, 100, 5000, len(sound) // 2, len(sound) - 1):
        refused(tmp_path / "models.h5", sound[:length], DamagedFileError)
    for length in (0, 7):
        refused(tmp_path / "models.h5", sound[:length], ForeignFileError)


@pytest.mark.parametrize("version", ["2.0", "17.3"])
def test_newer_major_version(tmp_path, sound, version):
    def edit(file):
        file.attrs["schema_version"] = np.bytes_(version)
        del file.attrs["materials"]

    path = tmp_path / "models.h5"
    message = refused(path, edited(path, sound, edit), NewerSchemaError)
    assert f"schema {version}" in message and "update goniosim" in message


def test_newer_minor_version(tmp_path, sound):
    """It may hold more than this reader knows."""

    def edit(file):
        file.attrs["schema_version"] = np.bytes_("1.9")
        file["synthetic/ww09/polarisation/stokes"] = [1.0]

    path = tmp_path / "models.h5"
    path.write_bytes(edited(path, sound, edit))
    with open_models(path) as models:
        assert models.schema_version == "1.9" and len(models.material("synthetic").models) == 2


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (lambda file: file.__delitem__("synthetic"), "the group synthetic of / is missing"),
        (lambda file: file.__delitem__("synthetic/ww09"), "the group ww09 of /synthetic is missing"),
        (lambda file: file.__delitem__("synthetic/cells/valid"), "cells/valid is missing"),
        (lambda file: file.__delitem__("synthetic/ww09/reflection/internal/bsdf"), "internal/bsdf is missing"),
        (lambda file: file.__delitem__("synthetic/ww09/reflection"), "has no component"),
        (lambda file: file.attrs.__delitem__("materials"), "the attribute materials of / is missing"),
        (lambda file: file.attrs.__delitem__("schema_version"), "schema_version"),
        (lambda file: file["synthetic"].attrs.__delitem__("main_component"), "main_component"),
        (lambda file: file["synthetic"].attrs.__setitem__("config_yaml", np.bytes_("x")), "does not match its digest"),
        (lambda file: file["synthetic"].attrs.__setitem__("name", np.bytes_("other")), "calls itself other"),
        (lambda file: file.attrs.__setitem__("materials", np.bytes_("a/b")), "the group a/b of / is missing"),
        (
            lambda file: file["synthetic"].attrs.__setitem__("main_component", np.bytes_("transmission")),
            "the model ww09 lacks the main component transmission",
        ),
    ],
)
def test_consistent_but_incomplete(tmp_path, sound, edit, words):
    path = tmp_path / "models.h5"
    assert re.search(words, refused(path, edited(path, sound, edit), DamagedFileError))


def test_consistent_but_misshapen(tmp_path, sound):
    def edit(file):
        del file["synthetic/ww09/reflection/internal/bsdf"]
        file["synthetic/ww09/reflection/internal/bsdf"] = [[[1.0]]]

    path = tmp_path / "models.h5"
    assert "has shape (1, 1, 1)" in refused(path, edited(path, sound, edit), DamagedFileError)
