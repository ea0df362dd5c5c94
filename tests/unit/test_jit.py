"""The cache of compiled code: keyed by all sources, private to goniosim, and never in the way."""

import os
import shutil
import subprocess
import sys

import numba

from goniosim import _jit


def test_an_edit_of_any_compiled_source_means_a_new_folder(tmp_path, monkeypatch):
    for folder in _jit._COMPILED:
        shutil.copytree(_jit._PACKAGE / folder, tmp_path / folder)
    monkeypatch.setattr(_jit, "_PACKAGE", tmp_path)
    before = _jit.source_hash()
    assert before == _jit.source_hash()
    with open(tmp_path / "optics" / "fresnel.py", "a") as f:
        f.write("# another comment\n")
    assert _jit.source_hash() != before


def test_the_cache_folder_of_others_is_left_alone():
    assert str(_jit.CACHE_FOLDER) != numba.config.CACHE_DIR


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
