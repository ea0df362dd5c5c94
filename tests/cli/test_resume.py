"""Runs that are stopped or killed, and go on: by the same command, to the same numbers."""

import contextlib
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

from goniosim.engine import simulate
from goniosim.report.text import counts
from goniosim.scene import parse_scene
from goniosim.store import open_result, read_state
from impatient import IMPATIENT, wait_for
from small import SCENE

# Some seconds of work, on any machine.
RAYS = "1e8"
ASKED = ("simulate", "scene.yaml", "--estimator", "analog", "--rays", RAYS)
# Checkpoints as often as can be, however much of the time they take.
_EAGER = (
    """
import goniosim.engine.checkpoints
goniosim.engine.checkpoints.MOST = 1.0
"""
    + IMPATIENT
)


def numbers(result):
    """Everything but times."""
    parts = [part for one in result.components.values() for part in (one, *one.orders.values())]
    names = ("energy", "stderr", "hits", "batches", "node_bias", "albedo_stderr")
    arrays = [getattr(part, name) for part in parts for name in names if getattr(part, name) is not None]
    return [result.rays, *arrays, *result.audit.energy.values(), *result.audit.stderr.values(), result.cost.rays]


def same(one, other):
    return all(np.array_equal(a, b) for a, b in zip(numbers(one), numbers(other), strict=True))


@pytest.fixture(scope="module")
def whole():
    """The result of an uninterrupted run."""
    return simulate(parse_scene(SCENE), rays=float(RAYS), estimator="analog")


@pytest.mark.slow
def test_stopped_twice_it_goes_on_to_the_same_numbers(python, goniosim, folder, whole):
    process = python(IMPATIENT, *ASKED)
    wait_for(process, f"% of {RAYS} rays")
    process.send_signal(signal.SIGUSR1)
    _, err = process.communicate()
    assert process.returncode == 75
    assert "stopped by SIGUSR1: small.h5 holds" in err and "the same command goes on" in err
    first = open_result(folder / "small.h5")
    assert first.status == "partial" and read_state(folder / "small.h5") is not None
    process = python(IMPATIENT, *ASKED, "--threads", "1")
    wait_for(process, f"small.h5: goes on from {counts(first.rays)} rays per direction")
    wait_for(process, f"% of {RAYS} rays")
    process.terminate()
    process.communicate()
    assert process.returncode == 75
    assert open_result(folder / "small.h5").rays[0] >= first.rays[0]
    code, out, err = goniosim(*ASKED)
    assert code == 0 and "small.h5: goes on from" in err
    found = open_result(folder / "small.h5")
    assert found.status == "complete" and read_state(folder / "small.h5") is None
    assert same(found, whole)


def test_a_time_limit_is_a_request_to_stop(python, folder, whole):
    """Kernels are compiled by now; more rays than any machine traces."""
    asked = ("simulate", "scene.yaml", "--estimator", "analog", "--rays", "1e11")
    process = python(IMPATIENT, *asked, "--time-limit", "8s")
    _, err = process.communicate(timeout=300)
    assert process.returncode == 75
    assert "stopped by the time limit: small.h5 holds" in err
    assert open_result(folder / "small.h5").status == "partial"


def test_a_killed_run_goes_on_from_its_last_checkpoint(python, goniosim, folder, whole):
    process = python(_EAGER, *ASKED, "--checkpoint", "0.2s")
    wait_for(process, f"% of {RAYS} rays")
    guard = threading.Timer(300.0, process.kill)
    guard.start()
    while not (folder / "small.h5").exists():
        assert process.poll() is None
    guard.cancel()
    process.kill()
    process.communicate()
    held = open_result(folder / "small.h5")
    assert held.status == "partial" and 0 < held.rays[0] < 1e8
    code, _, err = goniosim(*ASKED)
    assert code == 0 and "goes on from" in err
    assert same(open_result(folder / "small.h5"), whole)
    assert sorted(path.name for path in folder.iterdir()) == ["scene.yaml", "small.h5", "study.yaml"]


@pytest.mark.slow
def test_what_another_version_left_is_begun_anew(python, goniosim, folder, whole, monkeypatch):
    process = python(IMPATIENT, *ASKED)
    wait_for(process, f"% of {RAYS} rays")
    process.terminate()
    process.communicate()
    assert process.returncode == 75
    # A function of the package has the name of the module.
    monkeypatch.setattr(sys.modules["goniosim.engine.simulate"], "VERSION", [0, "0.0"])
    code, _, err = goniosim(*ASKED)
    assert code == 0 and "small.h5: begins anew: the interrupted run was of another version of goniosim" in err
    assert same(open_result(folder / "small.h5"), whole)


@pytest.mark.slow
@pytest.mark.parametrize(("estimator", "rays", "kills"), [("analog", 5e8, 40), ("auto", 2e7, 10)])
def test_killed_at_fifty_moments(python, goniosim, folder, estimator, rays, kills):
    """The file always opens, never holds less than before, and ends as if nothing had happened."""
    asked = ("simulate", "scene.yaml", "--estimator", estimator, "--rays", f"{rays:g}")
    whole = simulate(parse_scene(SCENE), rays=rays, estimator=estimator)
    moments = np.random.default_rng(1).uniform(0.5, 2.5, kills)
    path, held = folder / "small.h5", 0
    for moment in moments:
        process = python(_EAGER, *asked, "--checkpoint", "0.1s", "--threads", "1")
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(moment)
        process.kill()
        process.communicate()
        if path.exists():
            found = open_result(path)
            assert found.rays[0] >= held
            held = found.rays[0]
            if found.status == "complete":
                assert same(found, whole)
                path.unlink()
                held = 0
    assert goniosim(*asked)[0] == 0
    assert same(open_result(path), whole)
    assert sorted(path.name for path in folder.iterdir()) == ["scene.yaml", "small.h5", "study.yaml"]
