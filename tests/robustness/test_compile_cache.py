"""A damaged cache of compiled code is compiled over; one that cannot be written costs nothing."""

import errno
import os
import pickle
import shutil
import subprocess
import sys

import pytest
from numba import njit

from goniosim._jit import files


def _plus_one(x):
    return x + 1


def _fresh(folder):
    """The function as a new process finds it."""
    compiled = njit(nogil=True)(_plus_one)
    files.keep(compiled, folder)
    return compiled


def _run(folder, value=1):
    """Call it; tell whether the machine code came from the cache."""
    compiled = _fresh(folder)
    assert compiled(value) == value + 1
    return bool(compiled.stats.cache_hits)


@pytest.fixture
def notices(monkeypatch):
    noted = []
    monkeypatch.setattr(files, "notices", noted)
    return noted


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    folder = tmp_path_factory.mktemp("original")
    assert not _run(folder)
    assert _run(folder)
    return folder


@pytest.fixture
def kept(original, tmp_path):
    """A folder in which the function is kept."""
    return shutil.copytree(original, tmp_path / "cache")


def _cut(path):
    path.write_bytes(path.read_bytes()[:-1])


def _flip(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def _make_folder(path):
    path.unlink()
    path.mkdir()
    (path / "in the way").touch()


def _make_pipe(path):
    path.unlink()
    os.mkfifo(path)


DAMAGE = {
    "empty": lambda path: path.write_bytes(b""),
    "cut": _cut,
    "flipped": _flip,
    "another pickle": lambda path: path.write_bytes(pickle.dumps({"a": 1})),
    "missing": lambda path: path.unlink(),
    "a folder": _make_folder,
    "a pipe": _make_pipe,
    "unreadable": lambda path: path.chmod(0),
}


@pytest.mark.parametrize("damage", DAMAGE)
@pytest.mark.parametrize("kinds", [("nbc",), ("nbi", "nbc")], ids="-".join)
def test_what_is_damaged_is_compiled_over(kept, notices, kinds, damage):
    for kind in kinds:
        (path,) = kept.rglob(f"*.{kind}")
        DAMAGE[damage](path)
    root_reads_all = damage == "unreadable" and os.geteuid() == 0
    assert _run(kept) == root_reads_all
    assert _run(kept) and notices == []


def test_content_that_numba_cannot_rebuild_is_compiled_over(kept):
    """Whole, with its right key, but not what numba makes of a function."""
    compiled = _fresh(kept)
    (name,) = compiled._cache._cache_file._load_index().values()
    key, _ = compiled._cache._cache_file._load_data(name)
    compiled._cache._cache_file._save_data(name, (key, "nonsense"))
    assert not _run(kept)
    assert _run(kept)


def test_machine_code_of_another_signature_is_not_taken(kept):
    """As after two processes chose the same number at the same time."""
    _run(kept, 1.5)
    one, other = sorted(kept.rglob("*.nbc"))
    one.write_bytes(other.read_bytes())
    assert not _run(kept, 1)
    assert _run(kept, 1) and _run(kept, 1.5)


def test_a_full_disk_costs_nothing(tmp_path, monkeypatch, notices):
    def full(*arguments):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "replace", full)
    assert not _run(tmp_path) and not _run(tmp_path, 1.5)
    assert notices == ["compiled code is not kept: No space left on device"]
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


def test_a_folder_that_vanishes_costs_nothing(tmp_path, notices):
    """It is not made anew: who knows what lies above it by then."""
    (tmp_path / "cache").mkdir()
    compiled = _fresh(tmp_path / "cache")
    (made,) = (tmp_path / "cache").iterdir()
    made.rmdir()
    (tmp_path / "cache").rmdir()
    assert compiled(1) == 2 and not compiled.stats.cache_hits
    assert list(tmp_path.iterdir()) == []
    files.keep(compiled, tmp_path / "cache")
    assert compiled(1) == 2 and len(notices) == 2


SCENE = """\
material:
  name: small
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - interface: {type: lambert, rho: 0.5}
incident: {theta_deg: [30]}
slice: {rows: 6, columns: 12}
simulation: {rays: 1e4}
"""


@pytest.mark.slow
def test_a_cache_that_was_cut_to_nothing_fills_again(tmp_path):
    """The whole command; two of them fill the cache at the same time."""
    (tmp_path / "scene.yaml").write_text(SCENE)

    def run(*outputs):
        code = "from goniosim_cli.main import main; main()"
        processes = [
            subprocess.Popen(
                [sys.executable, "-c", code, "simulate", "scene.yaml", "-o", output],
                cwd=tmp_path,
                env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")},
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
            )
            for output in outputs
        ]
        noted = [process.communicate(timeout=500)[1] for process in processes]
        assert [process.returncode for process in processes] == [0] * len(outputs), noted

    def written():
        files = [path for path in (tmp_path / "cache").rglob("*") if path.suffix in (".nbi", ".nbc")]
        assert len(files) > 4 and all(path.stat().st_size for path in files)
        return {path: path.stat().st_mtime_ns for path in files}

    run("a.h5", "b.h5")
    # Of two that add to the same index, one may have been too late.
    run("c.h5")
    before = written()
    run("d.h5")
    assert written() == before
    for path in before:
        path.write_bytes(b"")
    run("e.h5")
    before = written()
    run("f.h5")
    assert written() == before
