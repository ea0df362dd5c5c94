"""`goniosim versions`, the command line in provenance, and the citation."""

import json
import os
import platform
import shlex
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest
from ruamel.yaml import YAML

import goniosim as package
from goniosim.store import open_result

ROOT = Path(package.__file__).resolve().parent.parent


def test_one_command_says_what_a_bug_report_needs(goniosim, monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    code, out, err = goniosim("versions", "--json")
    assert (code, err) == (0, "")
    found = json.loads(out)
    assert found["versions"]["goniosim"] == package.__version__
    for name in ("numba", "llvmlite", "numpy", "h5py", "matplotlib", "click", "tqdm", "pydantic", "ruamel.yaml"):
        assert found["versions"][name] == version(name)
    assert found["versions"]["libhdf5"] and platform.python_version() in found["versions"]["python"]
    assert {"operating_system", "processor", "cores"} <= found["machine"].keys()
    assert {"target", "vectors", "cache"} <= found["compiler"].keys()
    assert found["environment"]["OMP_NUM_THREADS"] == "3"
    code, text, _ = goniosim("versions")
    assert code == 0
    for group in found.values():
        for name, value in group.items():
            assert any(line.split() == [name, *value.split()] for line in text.splitlines()), name


def test_a_broken_installation_can_be_described(goniosim, monkeypatch):
    monkeypatch.setitem(sys.modules, "goniosim._jit.target", None)
    monkeypatch.setitem(sys.modules, "goniosim.store", None)
    code, out, _ = goniosim("versions", "--json")
    assert code == 0
    found = json.loads(out)
    assert "ModuleNotFoundError" in found["compiler"]["unusable"]
    assert "ModuleNotFoundError" in found["versions"]["libhdf5"]


def test_a_result_says_by_which_command_it_came(goniosim, folder):
    arguments = ["simulate", "scene.yaml", "-q", "-o", "a b.h5", "--rays", "1e3"]
    assert goniosim(*arguments)[0] == 0
    result = open_result(folder / "a b.h5")
    assert shlex.split(result.provenance["command"]) == ["goniosim", *arguments]
    assert {"processor", "cores", "operating_system"} <= result.provenance.keys()
    _, out, _ = goniosim("info", "a b.h5")
    assert result.provenance["command"] in out and result.provenance["processor"] in out
    # Called from Python, a simulation is nobody's command.
    assert "command" not in package.simulate("scene.yaml", rays=1000).provenance


@pytest.mark.skipif(not (ROOT / "CITATION.cff").exists(), reason="not the source tree")
def test_the_citation_is_of_this_version():
    cited = YAML(typ="safe").load(ROOT / "CITATION.cff")
    assert cited["cff-version"] == "1.2.0"
    assert {"message", "title", "authors", "version"} <= cited.keys()
    assert cited["authors"] == [{"name": "The goniosim developers"}]
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert (str(cited["version"]), cited["license"]) == (project["version"], project["license"])
    assert all(entry["authors"] and entry["title"] for entry in cited["references"])
    assert os.fspath(ROOT) not in (ROOT / "CITATION.cff").read_text()
