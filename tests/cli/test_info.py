"""`goniosim info`, `goniosim plot`, `goniosim schema`."""

import json

import h5py
import numpy as np
import pytest
from matplotlib.image import imread

from goniosim.store import write_result
from synthetic import make_result


@pytest.fixture
def result(folder):
    result = make_result(channels=("R", "G", "B"), status="partial")
    write_result(result, folder / "result.h5")
    return result


def test_info_shows_what_the_file_holds(goniosim, result):
    code, out, err = goniosim("info", "result.h5")
    assert (code, err) == (0, "")
    for words in (
        "result.h5  (",
        "synthetic  (partial)",
        "Albedo",
        "Energy audit",
        "Cost",
        "Effects",
        "Origin",
    ):
        assert words in out


def test_info_as_json_holds_the_numbers_themselves(goniosim, result):
    code, out, _ = goniosim("info", "result.h5", "--json")
    data = json.loads(out)
    assert code == 0
    assert data["status"] == "partial"
    assert data["albedo"]["reflection/internal"]["value"] == result.audit.energy["reflected_internal"].tolist()


def test_plot_writes_pictures_and_names_them(goniosim, result, folder):
    code, out, _ = goniosim("plot", "result.h5", "-o", "pictures")
    assert code == 0
    assert out.splitlines() == [
        "pictures/result.png",
        "pictures/result-theta_0.png",
        "pictures/result-theta_60.png",
    ]
    for line in out.splitlines():
        assert np.std(imread(folder / line)) > 0.05


def test_plot_of_one_direction_in_another_format(goniosim, result, folder):
    code, out, _ = goniosim("plot", "result.h5", "--theta", "60", "--format", "svg")
    assert (code, out) == (0, "result-theta_60.svg\n")
    assert b"<svg" in (folder / "result-theta_60.svg").read_bytes()


def test_schema_is_the_one_of_the_scene_package(goniosim):
    from goniosim.scene import json_schema

    code, out, _ = goniosim("schema")
    assert code == 0
    assert json.loads(out) == json_schema()


@pytest.mark.parametrize("command", [["info"], ["info", "--json"], ["plot", "--theta", "60", "--format", "svg"]])
def test_a_note_that_was_added_is_told_and_no_damage(goniosim, result, folder, command):
    sound = goniosim(command[0], "result.h5", *command[1:])
    with h5py.File("result.h5", "r+") as file:
        file.attrs["note"] = "mine"
    code, out, err = goniosim(command[0], "result.h5", *command[1:])
    assert (code, out.splitlines()[1:]) == (0, sound[1].splitlines()[1:])
    assert err.startswith("goniosim: note: result.h5: annotated: something was added") and err.count("\n") == 1
