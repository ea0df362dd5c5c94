"""Disks that fill up, fail, vanish or have no locks: old data stays, new is saved elsewhere, and one line says so."""

import errno
import os
import subprocess
import time

import numpy as np
import pytest
from click.testing import CliRunner
from goniosim_cli.main import main

from failing import FAULTS, Disk
from goniosim import engine
from goniosim.engine.simulate import simulate
from goniosim.scene import parse_scene
from goniosim.store import open_result, write_result
from goniosim.store.writer import encode
from reusing import encode_once
from small import SCENE

OLD, HALF, ALL = 1000, 5000, 10_000
# One of each kind; the others only differ in what the system says.
FEW = ("pwrite ENOSPC", "posix_fallocate EDQUOT", "fsync EIO", "replace EXDEV", "open EROFS", "stat EIO", "vanished")


def faults(*without):
    """Names of what can go wrong, but for some, most of them marked as slow."""
    names = [name for name in FAULTS if not name.startswith(without)]
    return [pytest.param(name, marks=() if name in FEW else pytest.mark.slow) for name in names]


@pytest.fixture(scope="module")
def results():
    """Of the same scene, with its rays or less."""
    scene = parse_scene(SCENE)
    made = {rays: simulate(scene, rays=rays, estimator="analog") for rays in (OLD, HALF, ALL)}
    for rays in (OLD, HALF):
        made[rays].status, made[rays].config_yaml = "partial", scene.to_yaml()
    made[ALL].config_yaml = scene.to_yaml()
    return made


@pytest.fixture(scope="module")
def earlier(results):
    return b"".join(encode(results[OLD]))


@pytest.fixture
def disk(tmp_path, monkeypatch, earlier):
    """A folder on a disk that can be made to fail, with an earlier result, and a temporary directory elsewhere."""
    for name in ("out", "temporary"):
        (tmp_path / name).mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    (tmp_path / "scene.yaml").write_text(SCENE)
    (tmp_path / "out" / "small.h5").write_bytes(earlier)
    monkeypatch.chdir(tmp_path)
    return Disk(tmp_path / "out", monkeypatch)


@pytest.fixture
def stages(monkeypatch, results):
    """Functions to be called as the simulation comes to its checkpoint, and to its end."""
    todo = {"checkpoint": lambda: None, "end": lambda: None}

    def staged(scene, progress, checkpoint, **_):
        progress(HALF, ALL)
        todo["checkpoint"]()
        checkpoint(results[HALF])
        todo["end"]()
        progress(ALL, ALL)
        return results[ALL]

    encode_once(monkeypatch)
    monkeypatch.setattr(engine, "simulate", staged)
    monkeypatch.setattr(engine, "warm_up", lambda scene: 0.0)
    return todo


def goniosim(*arguments):
    """Exit code and what was printed, but for the line on what the earlier result is good for."""
    outcome = CliRunner().invoke(main, list(arguments))
    said = [line for line in outcome.stderr.splitlines(True) if f"goes on from {OLD} rays per direction" not in line]
    return outcome.exit_code, outcome.stdout, "".join(said)


def rays_in(path):
    return open_result(path).rays.tolist()


def is_tidy(folder):
    return not folder.exists() or [path.name for path in folder.iterdir()] == ["small.h5"]


def test_nothing_fails(disk, stages):
    code, out, err = goniosim("simulate", "scene.yaml", "-o", "out/small.h5")
    assert (code, err) == (0, "") and "small  (complete)" in out
    assert rays_in("out/small.h5") == [ALL] and is_tidy(disk.folder)


@pytest.mark.parametrize("fault", faults("vanished"))
def test_at_the_start(disk, stages, fault, monkeypatch):
    """Before the first ray, if it can be known by then."""
    traced = []
    stages["checkpoint"] = lambda: traced.append(True)
    FAULTS[fault](disk)
    code, out, err = goniosim("simulate", "scene.yaml", "-o", "out/small.h5")
    monkeypatch.undo()
    lines = err.splitlines()
    assert code == 4 and out == ""
    assert lines[-1].startswith("goniosim: error: out")
    if traced:
        # Only the last step shows it: then there is a file, too.
        assert fault.partition(" ")[0] in ("pwrite", "replace", "ftruncate")
        assert "no checkpoint" in lines[0] and "the result was saved as" in lines[-1] and len(lines) == 2
    else:
        assert len(lines) == 1
    assert rays_in(disk.folder / "small.h5") == [OLD] and is_tidy(disk.folder)


@pytest.mark.parametrize("fault", faults())
def test_at_a_checkpoint(disk, stages, fault, monkeypatch):
    """It passes: the run goes on, and its end is as usual, or saved elsewhere."""
    sound = os.pwrite, os.posix_fallocate, os.fsync, os.replace, os.open, os.ftruncate, os.stat
    stages["checkpoint"] = lambda: FAULTS[fault](disk)

    def passes():
        for function in sound:
            monkeypatch.setattr(os, function.__name__, function)
        if fault != "vanished":
            assert rays_in(disk.folder / "small.h5") == [OLD]

    stages["end"] = passes
    code, out, err = goniosim("simulate", "scene.yaml", "-o", "out/small.h5")
    first, *more = err.splitlines()
    assert "small: no checkpoint: out/small.h5: " in first
    assert is_tidy(disk.folder)
    if fault == "vanished":
        (line,) = more
        assert code == 4 and "the result was saved as" in line
    else:
        assert (code, more) == (0, []) and rays_in("out/small.h5") == [ALL]


@pytest.mark.parametrize("fault", faults("posix_fallocate", "open"))
def test_at_the_end(disk, stages, fault, tmp_path, monkeypatch):
    """By then the checkpoint stands, and stays."""
    stages["end"] = lambda: FAULTS[fault](disk)
    code, out, err = goniosim("simulate", "scene.yaml", "-o", "out/small.h5")
    monkeypatch.undo()
    (line,) = err.splitlines()
    (saved,) = (tmp_path / "temporary").iterdir()
    assert (code, out) == (4, "") and line.startswith("goniosim: error: out/small.h5: ")
    assert line.endswith(f"the result was saved as {saved} instead")
    assert rays_in(saved) == [ALL] and is_tidy(disk.folder)
    if fault != "vanished":
        assert rays_in(disk.folder / "small.h5") == [HALF]


@pytest.mark.parametrize("number", [errno.EIO, errno.ESTALE])
def test_a_result_that_cannot_be_read_for_now_is_not_taken_for_a_damaged_one(
    disk, stages, tmp_path, monkeypatch, number
):
    """It holds what is worth more, but for the moment nobody knows."""
    write_result(simulate(parse_scene(SCENE), rays=2 * ALL), disk.folder / "small.h5")
    disk.reads(number)
    asked = ("simulate", "scene.yaml", "-o", "out/small.h5")
    code, _, err = goniosim(*asked)
    (line,) = err.splitlines()
    assert code == 4 and f"cannot be read: {os.strerror(number)}" in line and line.endswith("is not overwritten")
    (disk.folder / "small.h5").rename(tmp_path / "other.h5")
    stages["end"] = lambda: (tmp_path / "other.h5").rename(disk.folder / "small.h5")
    code, _, err = goniosim(*asked)
    monkeypatch.undo()
    (line,) = err.splitlines()
    assert code == 4 and "exists and cannot be read, so it is not overwritten" in line
    assert "remove" not in line and "the result was saved as" in line
    assert rays_in(disk.folder / "small.h5") == [2 * ALL] and is_tidy(disk.folder)


@pytest.mark.parametrize("number", [errno.ENOLCK, errno.EOPNOTSUPP])
def test_a_disk_without_locks(disk, stages, number):
    disk.fails("flock", number)
    code, _, err = goniosim("simulate", "scene.yaml", "-o", "out/small.h5")
    assert (code, err) == (0, "")
    assert rays_in("out/small.h5") == [ALL] and is_tidy(disk.folder)


def test_a_disk_that_cannot_allocate_ahead_or_sync_folders(disk, stages):
    disk.fails("posix_fallocate", errno.EOPNOTSUPP)
    disk.fails("utime", errno.EPERM)
    assert goniosim("simulate", "scene.yaml", "-q", "-o", "out/small.h5") == (0, "", "")
    assert rays_in("out/small.h5") == [ALL] and is_tidy(disk.folder)


@pytest.mark.parametrize("step", [-1e9, 1e9])
def test_a_clock_that_is_set_during_the_run(tmp_path, monkeypatch, step):
    """Once in the past, once in the future; with checkpoints as often as can be."""
    from goniosim.engine import checkpoints

    monkeypatch.setattr(checkpoints, "MOST", 1.0)
    real, kept = time.time, []

    def keep(result):
        kept.append(result.rays.sum())
        monkeypatch.setattr(time, "time", lambda: real() + step)
        (tmp_path / "r.h5").touch()

    scene = parse_scene(SCENE)
    asked = {"rays": 2e6, "estimator": "analog", "threads": 1}
    plain = simulate(scene, **asked)
    found = simulate(scene, checkpoint=keep, every=0.0, **asked)
    assert kept and kept == sorted(kept)
    assert np.array_equal(
        found.components["reflection/internal"].energy, plain.components["reflection/internal"].energy
    )
    assert found.cost.seconds.min() >= 0.0 and np.all(np.diff(found.cost.seconds, axis=-1) >= 0.0)


@pytest.fixture
def small_disk(disk):
    """A real file system of half a megabyte, with the earlier result."""
    earlier = (disk.folder / "small.h5").read_bytes()
    if subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=500k", "tmpfs", disk.folder], capture_output=True
    ).returncode:
        pytest.skip("only the administrator mounts file systems")
    (disk.folder / "small.h5").write_bytes(earlier)
    yield disk.folder
    subprocess.run(["umount", "-l", disk.folder], check=True)


def fill(folder):
    descriptor = os.open(folder / "others", os.O_WRONLY | os.O_CREAT)
    with pytest.raises(OSError, match="No space"):
        while True:
            os.write(descriptor, bytes(4096))
    os.close(descriptor)


def test_a_real_full_disk(small_disk, stages):
    fill(small_disk)
    code, out, err = goniosim("simulate", "scene.yaml", "-o", "out/small.h5")
    (line,) = err.splitlines()
    assert (code, out) == (4, "") and "No space left on device" in line
    assert rays_in(small_disk / "small.h5") == [OLD]
    assert sorted(path.name for path in small_disk.iterdir()) == ["others", "small.h5"]


@pytest.mark.parametrize("stage", ["checkpoint", "end"])
def test_a_real_disk_that_others_fill(small_disk, stages, stage):
    """There is no room for checkpoints any more; for the end it was kept."""
    stages[stage] = lambda: fill(small_disk)
    code, _, err = goniosim("simulate", "scene.yaml", "-o", "out/small.h5")
    assert code == 0 and ["no checkpoint" in line for line in err.splitlines()] == [True] * (stage == "checkpoint")
    assert rays_in(small_disk / "small.h5") == [ALL]
    assert sorted(path.name for path in small_disk.iterdir()) == ["others", "small.h5"]


def test_a_real_disk_that_is_read_only(small_disk, stages):
    subprocess.run(["mount", "-o", "remount,ro", small_disk], check=True)
    code, out, err = goniosim("simulate", "scene.yaml", "-o", "out/small.h5")
    (line,) = err.splitlines()
    assert (code, out) == (4, "") and "Read-only file system" in line
    assert rays_in(small_disk / "small.h5") == [OLD] and is_tidy(small_disk)
