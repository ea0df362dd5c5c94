"""`goniosim warmup`: what it compiles is all that runs take, and several at once compile it once."""

import os
import re
import subprocess
import sys
import threading
import time

import pytest

from goniosim._jit.folder import CACHE_FOLDER
from goniosim.cluster import warmup
from goniosim.parts import turn
from goniosim.scene import parse_scene
from small import SCENE

COMMAND = [sys.executable, "-c", "from goniosim_cli.main import main; main()"]


def test_kernels_that_were_compiled_before_are_loaded(folder, goniosim):
    assert goniosim("warmup", "scene.yaml")[0] == 0
    code, out, err = goniosim("warmup", "study.yaml")
    assert (code, err) == (0, "")
    found = r"all kernels were compiled before: loaded in .+\n  cache   (.+) \(\d+ kernels\)\n"
    assert re.fullmatch(found, out)[1] == str(CACHE_FOLDER)
    assert sorted(path.name for path in folder.iterdir()) == ["scene.yaml", "study.yaml"]


def test_another_process_that_compiles_is_waited_for(folder, goniosim):
    held = threading.Event()

    def hold():
        with turn(CACHE_FOLDER):
            held.set()
            time.sleep(1.2)

    other = threading.Thread(target=hold)
    other.start()
    held.wait()
    code, out, _ = goniosim("warmup", "scene.yaml")
    other.join()
    assert code == 0 and ", after waiting 1." in out and "for another process\n" in out


@pytest.fixture
def tried(monkeypatch):
    """Scenes that are simulated, which takes no time."""
    found = []
    monkeypatch.setattr("goniosim.engine.simulate", lambda scene, **_: found.append(scene))
    return found


def test_each_kind_of_stack_is_tried_once(tried):
    rough = [parse_scene(SCENE, overrides=[f"material.layers[0].interface.alpha={alpha}"]) for alpha in (0.1, 0.2, 0.3)]
    smooth = parse_scene(SCENE, overrides=["material.layers[0].interface.alpha=0"])
    warmup.keep_warm([*rough, smooth])
    assert [scene.material.interfaces[0].alpha for scene in tried] == [0.3, 0.0]


def test_as_little_as_runs_the_kernels_is_traced_whatever_is_asked(tried):
    target = {"target": {"relative_error": 1e-6}, "max_time": "10h"}
    asked = parse_scene(SCENE, overrides=[f"simulation={target}", "incident.theta_deg=[0, 80]", "slice.rows=900"])
    warmup.keep_warm([asked])
    ((scene,), few) = tried, 131072
    assert (scene.simulation.target, scene.simulation.rays, scene.slice.rows) == (None, few, 6)
    assert scene.incident.theta_deg == (0.0,)


def test_no_place_for_compiled_code_is_said(folder, goniosim, monkeypatch):
    monkeypatch.setattr(warmup, "CACHE_FOLDER", None)
    monkeypatch.setattr(warmup, "notices", ["compiled code is not kept in /nowhere: it is not there"])
    code, _, err = goniosim("warmup", "scene.yaml")
    assert code == 10 and err.count("\n") == 1
    assert "in /nowhere: it is not there; name one: NUMBA_CACHE_DIR" in err


@pytest.mark.slow
def test_after_it_nothing_is_left_to_compile(tmp_path):
    """Two at once: one compiles, the other loads. Then every example, by every estimator that serves it."""
    place = {"env": os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}, "cwd": tmp_path, "text": True}

    def kept():
        return {path: path.stat().st_mtime_ns for path in (tmp_path / "cache").rglob("*.nbc")}

    both = [subprocess.Popen([*COMMAND, "warmup"], stdout=subprocess.PIPE, **place) for _ in range(2)]
    said = sorted(process.communicate(timeout=500)[0] for process in both)
    assert [process.returncode for process in both] == [0, 0]
    assert said[0].startswith(f"{len(kept())} kernels compiled in")
    assert "loaded in" in said[1] and "for another process" in said[1]
    before = kept()
    small = ["--set", "slice.rows=6", "--set", "slice.columns=12", "--set", "incident.theta_deg=[30]"]
    for name in ("plastic", "metal", "slab", "quickstart"):
        subprocess.run([*COMMAND, "init", name], check=True, capture_output=True, **place)
        for options in (["--estimator", "auto"], ["--estimator", "split"], ["--set", "simulation.orders=2"]):
            asked = ["simulate", f"{name}.yaml", "-o", "r.h5", "--overwrite", "--rays", "2e5", *small, *options]
            subprocess.run([*COMMAND, *asked], check=True, capture_output=True, **place)
    for arguments in (
        *(["simulate", "slab.yaml", "--shard", f"{shard}/2", "-o", "shards", *small] for shard in (1, 2)),
        ["merge", "shards", "-o", "merged.h5"],
    ):
        subprocess.run([*COMMAND, *arguments], check=True, capture_output=True, **place)
    assert kept() == before
