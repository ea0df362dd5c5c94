"""The cache of compiled code: keyed by all sources, private to goniosim, and never in the way."""

import os
import shutil
import subprocess
import sys

import numba
import pytest

from goniosim import _jit
from goniosim._jit import folder


def test_an_edit_of_any_compiled_source_means_a_new_folder(tmp_path, monkeypatch):
    for name in folder._COMPILED:
        shutil.copytree(folder._PACKAGE / name, tmp_path / name)
    monkeypatch.setattr(folder, "_PACKAGE", tmp_path)
    before = folder.source_hash()
    assert before == folder.source_hash()
    with open(tmp_path / "optics" / "fresnel.py", "a") as f:
        f.write("# another comment\n")
    assert folder.source_hash() != before


def test_the_cache_folder_of_others_is_left_alone():
    assert str(_jit.CACHE_FOLDER) != numba.config.CACHE_DIR


@pytest.fixture
def places(tmp_path, monkeypatch):
    """The three candidates, as empty folders of the test."""
    found = {}
    for variable, name in (("NUMBA_CACHE_DIR", "chosen"), ("XDG_CACHE_HOME", "home"), ("TMPDIR", "temporary")):
        found[name] = tmp_path / name
        found[name].mkdir()
        monkeypatch.setenv(variable, str(found[name]))
    monkeypatch.setattr("tempfile.tempdir", None)
    monkeypatch.setattr(folder, "notices", [])
    return found


def test_the_folder_that_the_user_names_comes_first(places):
    assert folder.cache_folder() == places["chosen"] / "goniosim" / folder.source_hash()
    assert folder.notices == []


def test_an_unusable_place_is_passed_over_and_said(places):
    """A file in the way of the first two; nobody's home; at last no temporary folder either."""
    for name in ("chosen", "home"):
        places[name].rmdir()
        places[name].write_text("not a folder")
    found = folder.cache_folder()
    assert found == places["temporary"] / f"cache-{os.getuid()}" / "goniosim" / folder.source_hash()
    assert [str(places["chosen"]) in folder.notices[0], str(places["home"]) in folder.notices[1]] == [True, True]


def test_without_any_place_there_is_no_cache_and_no_error(places, monkeypatch):
    def nowhere():
        raise FileNotFoundError(2, "No usable temporary directory found")

    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    # What `expanduser` answers for a user without a home.
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setattr("os.path.expanduser", lambda path: path)
    monkeypatch.setattr("tempfile.gettempdir", nowhere)
    assert folder.cache_folder() is None
    assert folder.notices == [
        "compiled code is not kept in a temporary folder: No usable temporary directory found",
    ]


@pytest.mark.slow
def test_an_unwritable_home_falls_back(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    environment = {
        **os.environ,
        "HOME": str(blocked),
        "XDG_CACHE_HOME": str(blocked),
        "NUMBA_CACHE_DIR": str(blocked),
        "TMPDIR": str(tmp_path),
    }
    code = "from goniosim import _jit; print(_jit.CACHE_FOLDER)"
    found = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert found.stdout.startswith(str(tmp_path / "cache-"))


@pytest.mark.slow
@pytest.mark.parametrize(
    "setting",
    ["NUMBA_NUM_THREADS=0", "NUMBA_NUM_THREADS=abc", "NUMBA_OPT=9", "NUMBA_DISABLE_JIT=1", "NUMBA_CPU_NAME=foo"],
)
def test_what_numba_cannot_read_is_one_line(setting):
    name, _, value = setting.partition("=")
    code = "from goniosim_cli.main import main; main()"
    found = subprocess.run(
        [sys.executable, "-c", code, "models"], env=os.environ | {name: value}, capture_output=True, text=True
    )
    assert (found.returncode, found.stdout) == (10, "")
    assert found.stderr.startswith(f"goniosim: error: {setting}: ") and found.stderr.count("\n") == 1
    assert "unset this environment variable" in found.stderr


@pytest.mark.parametrize("value", ["0", "-1", "abc", "1.5", ""])
def test_a_number_of_threads_that_numba_fails_on_is_refused(monkeypatch, value):
    from goniosim._jit import environment
    from goniosim.errors import RefusalError

    monkeypatch.setenv("NUMBA_NUM_THREADS", value)
    with pytest.raises(RefusalError, match=f"NUMBA_NUM_THREADS={value}: must be a whole number"):
        environment._check_threads()
