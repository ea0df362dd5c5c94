"""The installed package holds every folder of the source."""

import tomllib
from pathlib import Path

import pytest

import goniosim

ROOT = Path(goniosim.__file__).resolve().parent.parent


def test_every_package_is_listed():
    if not (ROOT / "pyproject.toml").exists():
        pytest.fail("run the tests against an editable install or the source tree")
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    folders = {path.parent for path in (ROOT / "goniosim").rglob("__init__.py")}
    names = {".".join(folder.relative_to(ROOT).parts) for folder in folders}
    assert set(settings["packages"]) == names | {"goniosim_cli"}


def test_type_checkers_find_the_annotations():
    """The marker of PEP 561 lies in the package and goes into the wheel."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    assert "py.typed" in settings["package-data"]["goniosim"]
    assert (ROOT / "goniosim" / "py.typed").is_file()
