"""Ctrl-C, SIGTERM and SIGHUP, in a process of its own."""

import json
import signal

import pytest
from goniosim_cli.signals import WARNINGS, undisturbed

from goniosim.store import open_result, write_result
from impatient import IMPATIENT, wait_for
from synthetic import make_result

# More than any machine traces during a test.
FOREVER = "1e11"


@pytest.mark.parametrize(
    ("signum", "code", "estimator"),
    [
        (signal.SIGINT, 130, "auto"),
        (signal.SIGTERM, 75, "analog"),
        (signal.SIGHUP, 75, "analog"),
        (signal.SIGUSR1, 75, "auto"),
        *(pytest.param(each, 75, "auto", marks=pytest.mark.slow) for each in WARNINGS if each != signal.SIGUSR1),
    ],
)
def test_what_was_gathered_is_kept(python, folder, signum, code, estimator):
    process = python(IMPATIENT, "simulate", "scene.yaml", "--rays", FOREVER, "--estimator", estimator)
    wait_for(process, f"% of {FOREVER} rays")
    process.send_signal(signum)
    out, err = process.communicate()
    assert process.returncode == code
    result = open_result(folder / "small.h5")
    assert result.status == "partial"
    assert 0 < result.rays[0] < 1e11
    assert abs(result.audit.residual).max() < 1e-12
    assert "% of the rays (partial)" in err
    assert "small  (partial)" in out
    assert sorted(path.name for path in folder.iterdir()) == ["scene.yaml", "small.h5", "study.yaml"]


def test_a_stopped_study_keeps_its_part_and_goes_on_later(python, goniosim, folder):
    asked = ("simulate", "study.yaml", "--estimator", "analog", "-o", "out")
    goniosim(*asked, "-q", "--rays", "1e3")
    process = python(IMPATIENT, *asked, "--rays", FOREVER)
    wait_for(process, "1/3 coat-0.1: ")
    process.send_signal(signal.SIGINT)
    process.communicate()
    assert process.returncode == 130
    assert open_result(folder / "out" / "coat-0.1.h5").status == "partial"
    assert open_result(folder / "out" / "coat-0.2.h5").rays.tolist() == [1000]
    # All that was asked for is there, and more.
    (folder / "out" / "coat-0.2.h5").unlink()
    _, _, err = goniosim(*asked, "--rays", "1e3")
    assert "2 of 3 materials have enough rays, though 1 of them partial: skipped" in err
    assert open_result(folder / "out" / "coat-0.1.h5").rays[0] > 1000


_SLOW_COMPILER = """
import sys, time
import goniosim.engine
goniosim.engine.warm_up = lambda scene: time.sleep(600)
from goniosim_cli.main import main
main()
"""


def test_before_the_first_rays_there_is_nothing_to_keep_and_nothing_towait_for(python, folder):
    process = python(_SLOW_COMPILER, "simulate", "scene.yaml")
    wait_for(process, "preparing the kernels")
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert out == ""
    assert err.strip() == "goniosim: stopped by Ctrl-C before the first rays"
    assert sorted(path.name for path in folder.iterdir()) == ["scene.yaml", "study.yaml"]


_DEAF_ENGINE = """
import sys, time
import goniosim.engine
def deaf(scene, progress, stop, **_):
    progress(1, 10)
    print("tracing", file=sys.stderr, flush=True)
    stop.wait()
    time.sleep(0.5)
    print("asked to stop", file=sys.stderr, flush=True)
    time.sleep(600)
goniosim.engine.simulate = deaf
from goniosim_cli.main import main
main()
"""


def test_a_second_ctrl_c_ends_at_once(python, folder):
    process = python(_DEAF_ENGINE, "simulate", "scene.yaml")
    wait_for(process, "tracing")
    process.send_signal(signal.SIGINT)
    wait_for(process, "asked to stop")
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "stopped by Ctrl-C at once: what was gathered since the last checkpoint is not kept" in err
    assert sorted(path.name for path in folder.iterdir()) == ["scene.yaml", "study.yaml"]


def test_one_signal_delivered_twice_is_one(python, folder):
    process = python(_DEAF_ENGINE.replace("time.sleep(600)", "raise SystemExit(99)"), "simulate", "scene.yaml")
    wait_for(process, "tracing")
    process.send_signal(signal.SIGTERM)
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=60)
    assert process.returncode == 99


def test_a_comparison_that_is_stopped_leaves_nothing_unfinished(start, folder):
    """Neither the hidden file of slices nor a process that draws."""
    plastic = make_result(components=("reflection/direct", "reflection/internal"), rows=90, columns=360)
    write_result(plastic, folder / "plastic.h5")
    (folder / "report").mkdir()
    earlier = json.dumps({"filetype": "goniosim-errors", "results": [], "files": ["errors.json", "errors.csv"]})
    (folder / "report" / "errors.json").write_text(earlier)
    (folder / "report" / "errors.csv").write_text("the earlier table")
    process = start("compare", "plastic.h5", "-o", "report", "--models", "ww09", "--subcells", "1")
    wait_for(process, "drawing")
    process.send_signal(signal.SIGTERM)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 143
    assert (out, err.strip()) == ("", "goniosim: stopped by SIGTERM")
    # The earlier report is complete, and nothing lies beside it.
    assert sorted(path.name for path in (folder / "report").rglob("*")) == ["errors.csv", "errors.json"]
    assert (folder / "report" / "errors.json").read_text() == earlier
    assert not list(folder.glob(".*"))


def test_a_signal_waits_while_files_are_moved():
    moved = []
    # As in a terminal: a shell lets what it starts in the background ignore Ctrl-C.
    earlier = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt), undisturbed():
            signal.raise_signal(signal.SIGINT)
            moved.append("all")
    finally:
        signal.signal(signal.SIGINT, earlier)
    assert moved == ["all"]
