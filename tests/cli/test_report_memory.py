"""The memory of reports: told by `check`, refused where it is short, and as measured."""

import json
import os
import time
from pathlib import Path

import pytest

from goniosim.compare.variants import check_request
from goniosim.report import memory
from goniosim.store import read_scene, write_result
from synthetic import make_result

MB = 1_000_000


@pytest.fixture
def result(folder):
    """A result file and its path."""
    write_result(make_result(components=("reflection/direct", "reflection/internal")), folder / "r.h5")
    return folder / "r.h5"


@pytest.fixture
def small_machine(monkeypatch):
    """A machine on which nothing fits."""
    monkeypatch.setattr(memory, "free_memory", lambda: (10 * MB, "in a test"))
    monkeypatch.setattr(memory, "resident_memory", lambda: 0)


def test_check_tells_it(folder, goniosim, monkeypatch):
    monkeypatch.setattr("goniosim.report.simulation.forecast.PROBE", 0.01)
    code, out, _ = goniosim("check", "scene.yaml", "--json")
    small = json.loads(out)["report_memory_bytes"]
    code, out, _ = goniosim("check", "scene.yaml", "--json", "--set", "slice.rows=1000", "--set", "slice.columns=1000")
    large = json.loads(out)["report_memory_bytes"]
    assert code == 0 and small["compare"] > 200 * MB and small["plot"] > 200 * MB
    # One direction of 10^6 cells, 3 channels: 24 MB for each set of slices; the result has at least 4 of them.
    assert large["plot"] > small["plot"] + 150 * MB and large["compare"] > small["compare"] + 500 * MB
    assert "for compare with all models" in goniosim("check", "scene.yaml")[1]
    assert "compare with all models takes at most" in goniosim("check", "study.yaml")[1]
    study = json.loads(goniosim("check", "study.yaml", "--json")[1])
    each = [one["report_memory_bytes"]["compare"] for one in study["materials"]]
    assert study["report_memory_bytes"]["compare"] == max(each)


def test_what_is_left_out_is_not_counted(result):
    scene = read_scene(result)
    whole = memory.memory_to_compare(scene)
    assert whole > memory.memory_to_compare(scene, figures="none") > 0
    assert whole > memory.memory_to_compare(scene, check_request(["ww09"])) > 0
    assert memory.memory_to_plot(scene) > memory.memory_to_plot(scene, overview=False)


@pytest.mark.parametrize(
    ("command", "remedy"),
    [(["plot"], "fewer incident directions"), (["compare", "--models", "ww09,bati19_ww"], "(--models)")],
)
def test_what_does_not_fit_is_refused_before_anything_is_made(result, goniosim, small_machine, command, remedy):
    before = sorted(os.listdir(result.parent))
    code, _, err = goniosim(command[0], result, *command[1:], "-o", "new")
    assert code == 4 and err.count("\n") == 1, err
    assert "r.h5: not enough memory: about 0." in err and "0.01 GB can be had (in a test)" in err and remedy in err
    assert sorted(os.listdir(result.parent)) == before


def _held(pid, counted=("Rss:",)):
    """Bytes that a process and those that it started hold, memory that they share counted once.

    Libraries are shared with other tests that run at the same time, which is no gain: all of the process, and of those
    that it started what is their own.
    """
    total = 0
    try:
        lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
        total += sum(1024 * int(line.split()[1]) for line in lines if line.startswith(counted))
        for task in os.listdir(f"/proc/{pid}/task"):
            children = Path(f"/proc/{pid}/task/{task}/children").read_text().split()
            total += sum(_held(int(child), ("Private_Clean:", "Private_Dirty:")) for child in children)
    except OSError:
        pass
    return total


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/smaps_rollup").exists(), reason="other systems do not tell")
@pytest.mark.parametrize(("angles", "rows", "columns"), [(1, 90, 360), (20, 90, 360), (1, 600, 1200)])
@pytest.mark.parametrize("command", ["plot", "compare"])
def test_the_memory_that_is_predicted_is_taken(folder, start, command, angles, rows, columns):
    theta_deg = [4.0 * i for i in range(angles)]
    components = ("reflection/direct", "reflection/internal")
    write_result(make_result(theta_deg, rows=rows, columns=columns, components=components), folder / "r.h5")
    scene = read_scene(folder / "r.h5")
    predicted = memory.memory_to_plot(scene) if command == "plot" else memory.memory_to_compare(scene)
    taken = 0
    with start(command, "r.h5", "-o", "new") as process:
        while process.poll() is None:
            taken = max(taken, _held(process.pid))
            time.sleep(0.02)
        assert process.returncode == 0, process.stderr.read()
    assert taken - 50 * MB < predicted < 1.3 * taken + 150 * MB
