"""`goniosim info` of folders and of several files, `goniosim models --json`, configurations from a pipe."""

import json
import shutil

import pytest

from goniosim import simulate
from goniosim.models import MODELS
from goniosim.scene import parse_scene
from goniosim.store import write_result
from small import SCENE, STUDY


@pytest.fixture(scope="module")
def simulated(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    for alpha in (0.1, 0.2, 0.3):
        changes = [f"material.name=coat-{alpha}", f"material.layers[0].interface.alpha={alpha}", "simulation.rays=100"]
        write_result(simulate(parse_scene(SCENE, overrides=changes)), folder / f"coat-{alpha}.h5")
    return folder


@pytest.fixture
def results(simulated, folder):
    """A folder ``three-coats`` with three results."""
    return shutil.copytree(simulated, folder / "three-coats")


def test_a_folder_is_a_table(goniosim, results):
    code, out, err = goniosim("info", results)
    assert (code, err) == (0, "")
    lines = out.splitlines()
    for name in ("coat-0.1.h5", "coat-0.2.h5", "coat-0.3.h5"):
        (line,) = [line for line in lines if line.split()[:1] == [name]]
        assert "complete" in line
        assert " 100 " in line
        assert "classic, 6 x 12" in line
        assert line.endswith("kB")
    assert lines[-2].startswith("  3 results, ") and "headers alone" in lines[-1]


def test_what_is_damaged_or_foreign_is_named(goniosim, results):
    damaged = results / "coat-0.2.h5"
    content = damaged.read_bytes()
    damaged.write_bytes(content[: len(content) // 2])
    (results / "notes.h5").write_text("not HDF5")
    (results / "notes.txt").write_text("left alone")
    code, out, err = goniosim("info", results)
    assert code == 6
    assert "  2 results, " in out
    (line,) = err.splitlines()
    assert line.startswith(f"goniosim: error: {damaged}: is cut off")
    (other,) = [line for line in out.splitlines() if "notes" in line]
    assert other.startswith(f"  {results / 'notes.h5'}: is not a goniosim result")
    # In a folder other things may lie; what is named has to be a result.
    damaged.unlink()
    assert goniosim("info", results)[0] == 0
    code, out, err = goniosim("info", results, results / "notes.txt")
    assert code == 5
    assert "  2 results, " in out
    assert len(err.splitlines()) == 1


def test_the_table_as_json(goniosim, results):
    shutil.copy(results / "coat-0.1.h5", results / "again.h5")
    code, out, _ = goniosim("info", results / "again.h5", results, "--json")
    assert code == 0
    first, *rest = json.loads(out)
    assert {key: first[key] for key in ("kind", "name", "status", "estimator", "rays", "theta_deg", "seed")} == {
        "kind": "result",
        "name": "coat-0.1",
        "status": "complete",
        "estimator": "analog",
        "rays": 100,
        "theta_deg": [30.0],
        "seed": 1,
    }
    assert first["slice"] == {"parametrization": "classic", "rows": 6, "columns": 12}
    assert first["bytes"] == (results / "again.h5").stat().st_size
    assert len(rest) == 4
    assert "again.h5 (coat-0.1)" in goniosim("info", results)[1]


def test_an_empty_folder_is_8(goniosim, folder):
    (folder / "empty").mkdir()
    code, out, err = goniosim("info", "empty")
    assert (code, out) == (8, "")
    assert err == "goniosim: error: empty: holds no result files (*.h5); give a folder of results\n"


def test_models_as_json(goniosim):
    code, out, _ = goniosim("models", "--json")
    assert code == 0
    entries = {entry["name"]: entry for entry in json.loads(out)}
    assert list(entries) == list(MODELS)
    for name, entry in entries.items():
        assert entry["citation"] == MODELS[name].citation
        assert entry["nanoseconds"] > 0
        for option in entry["options"]:
            assert option["default"] == option["values"][0]
    assert entries["ww09"]["family"] == "weidlich_wilkie"
    assert entries["bati19_belcour"]["family"] == "belcour"
    assert "masking" in [option["name"] for option in entries["ww09"]["options"]]
    assert entries["ww09"]["components"] == ["reflection", "reflection/direct", "reflection/internal"]
    assert "transmission" in entries["belcour18_forward"]["components"]


def test_a_scene_comes_from_a_pipe(goniosim, folder):
    code, _, err = goniosim("simulate", "-", "--rays", "100", stdin=SCENE)
    assert code == 0, err
    assert (folder / "small.h5").is_file()
    for command in ("check", "simulate"):
        code, _, err = goniosim(command, "-", stdin=SCENE.replace("tau: 0.2", "tau: -1"))
        assert code == 3
        assert err.startswith("<stdin>:5: material.layers[1].medium.tau: ")


def test_a_study_comes_from_a_pipe(goniosim, folder):
    code, _, err = goniosim("simulate", "-", "--rays", "100", "--set", "study.name=piped", stdin=STUDY)
    assert code == 0, err
    assert len(list((folder / "piped").glob("*.h5"))) == 3
