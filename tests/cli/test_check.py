"""`goniosim check`: what it predicts, for people and for programs, and that it leaves nothing behind."""

import json
import os
import subprocess
import sys

import pytest

from goniosim.engine import memory

MB = 1_000_000


@pytest.fixture(autouse=True)
def short_probe(monkeypatch):
    monkeypatch.setattr("goniosim.report.simulation.forecast.PROBE", 0.01)
    monkeypatch.setattr("goniosim.report.simulation.forecast.PROBE_STUDY", 0.01)


@pytest.fixture
def small_machine(monkeypatch):
    """A machine on which nothing fits."""
    monkeypatch.setattr(memory, "free_memory", lambda: (10 * MB, "in a test"))
    monkeypatch.setattr(memory, "resident_memory", lambda: 0)


def _parsed(goniosim, *arguments):
    def refuse(name):
        raise AssertionError(f"{name} is no JSON")

    code, out, err = goniosim("check", *arguments, "--json")
    assert code == 0, err
    return json.loads(out, parse_constant=refuse)


def test_json_of_one_scene(folder, goniosim):
    one = _parsed(goniosim, "scene.yaml", "--rays", "1e12", "--threads", "3", "--set", "slice.rows=8")
    assert (one["name"], one["rays"], one["directions"], one["threads"]) == ("small", 10**12, 1, 3)
    assert one["seconds"] == pytest.approx(1e12 / one["rays_per_second"])
    assert one["memory_bytes"] >= one["memory"]["program"] + one["memory"]["result"] > 0
    assert one["file_bytes"] > 0 and one["memory_shortage"] is None and one["absent_interfaces"] == []
    assert one["effects"]["absorption"]["active"] and not one["effects"]["transmission"]["active"]
    assert "layers[1]" in one["effects"]["absorption"]["why"] and one["lost_event_cap"] >= 0.0


def test_json_of_a_study_adds_up_time_and_files_but_not_memory(folder, goniosim):
    study = _parsed(goniosim, "study.yaml")
    materials = study["materials"]
    assert study["name"] == "three-coats" and len(materials) == 3
    for key in ("seconds", "file_bytes"):
        assert study[key] == pytest.approx(sum(one[key] for one in materials))
    assert study["memory_bytes"] == max(one["memory_bytes"] for one in materials)


def test_memory_stands_beside_time_and_size(folder, goniosim):
    _, out, _ = goniosim("check", "scene.yaml", "--threads", 1)
    assert "MB on 1 thread: " in out and "Warning" not in out
    _, out, _ = goniosim("check", "study.yaml")
    assert "memory" in out.splitlines()[1] and "at a time" in out.splitlines()[-2]


def test_what_does_not_fit_here_is_said_and_predicted_all_the_same(folder, goniosim, small_machine):
    one = _parsed(goniosim, "scene.yaml")
    assert "0.01 GB can be had (in a test)" in one["memory_shortage"] and one["seconds"] > 0.0
    _, out, _ = goniosim("check", "study.yaml")
    assert out.count("Warning: memory: coat-") == 3


@pytest.mark.parametrize("output", ["r.h5", "new/deep/r.h5", "new"])
def test_an_output_that_can_be_written_leaves_nothing(folder, goniosim, output):
    before = sorted(os.listdir(folder))
    config = "study.yaml" if output == "new" else "scene.yaml"
    code, out, _ = goniosim("check", config, "-o", output)
    assert code == 0 and f"{output} can be written" in out
    assert sorted(os.listdir(folder)) == before


OBSTACLES = {
    "foreign": ("scene.yaml", "scene.yaml", "not a goniosim result"),
    "folder": ("scene.yaml", ".", "is a folder"),
    "below a file": ("study.yaml", "scene.yaml/results", "is not a folder"),
}


@pytest.mark.parametrize("case", OBSTACLES)
def test_an_output_that_cannot_be_written_is_an_error(folder, goniosim, case):
    config, output, words = OBSTACLES[case]
    code, _, err = goniosim("check", config, "-o", output)
    assert code == 4 and words in err and err.count("\n") == 1


def test_an_output_without_room_is_an_error(folder, goniosim):
    huge = {"slice.rows": 1900, "slice.columns": 2000, "simulation.orders": 16, "incident.theta_deg": [*range(90)]}
    options = [option for path, value in huge.items() for option in ("--set", f"{path}={value}")]
    code, _, err = goniosim("check", "study.yaml", "-o", "out", *options)
    assert code == 4 and "no room for about" in err


def test_simulate_refuses_what_does_not_fit(folder, goniosim, small_machine):
    for config in ("scene.yaml", "study.yaml"):
        code, _, err = goniosim("simulate", config, "--threads", 2, "-o", "out")
        assert code == 4 and "not enough memory" in err and "0.01 GB can be had" in err
    assert not [name for name in os.listdir(folder) if name.endswith((".h5", ".part"))]


def test_memory_that_runs_out_in_any_command_is_no_bug(folder, goniosim, monkeypatch):
    def greedy(*_, **__):
        raise MemoryError

    monkeypatch.setattr("goniosim.report.simulation.forecast.forecasts", greedy)
    code, _, err = goniosim("check", "scene.yaml")
    assert code == 4 and "memory ran out" in err and "bug" not in err


def _peak(arguments):
    """Largest resident size in bytes of a command that succeeds."""
    script = "import sys; from goniosim_cli.main import main; sys.argv[0] = 'goniosim'; main()"
    pid = os.spawnv(os.P_NOWAIT, sys.executable, [sys.executable, "-c", script, *map(str, arguments)])
    _, status, usage = os.wait4(pid, 0)
    assert status == 0
    return usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024), usage.ru_stime


def _stack(n, alpha, base="{type: lambert, rho: [0.5, 0.6, 0.7]}"):
    layers = [
        f"    - interface: {{type: dielectric, eta: {1.33 if i % 2 else 1.5}, alpha: {alpha}}}\n"
        "    - medium: {tau: [0.0, 0.001, 0.002]}\n"
        for i in range(n - 1)
    ]
    return "".join(layers) + f"    - interface: {base}\n"


# Interfaces, alpha, base, angles, rows, columns, rays, threads.
SCENES = {
    # A slice with noise: without, files are a fraction of what is predicted.
    "directions": (2, 0.5, "{type: conductor, eta: 1.45, kappa: 1.0, alpha: 0.2}", 60, 90, 360, 300_000, 1),
    "threads": (2, 0.5, "{type: dielectric, eta: 1.0, alpha: 0.5}", 2, 200, 720, 2000, 24),
    "layers": (600, 0.0, None, 1, 9, 18, 100, 2),
    "cells": (2, 0.5, None, 1, 1000, 1000, 2_000_000, 1),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", SCENES)
def test_the_memory_that_is_predicted_is_taken(folder, goniosim, case):
    n, alpha, base, angles, rows, columns, rays, threads = SCENES[case]
    thetas = [round(89.0 * i / angles, 3) for i in range(angles)]
    (folder / "big.yaml").write_text(
        f"material:\n  name: big\n  layers:\n{_stack(n, alpha, *([base] if base else []))}"
        f"incident: {{theta_deg: {thetas}}}\nslice: {{rows: {rows}, columns: {columns}}}\n"
        f"simulation: {{rays: {rays}, seed: 1}}\n"
    )
    predicted = _parsed(goniosim, "big.yaml", "--threads", threads)["memory_bytes"]
    taken, _ = _peak(["simulate", "big.yaml", "--threads", threads, "-q", "-o", "big.h5"])
    # A part is predicted for the compiler, which runs in a first run only.
    assert taken - 50 * MB < predicted < 1.3 * taken + 150 * MB


@pytest.mark.slow
@pytest.mark.parametrize(("n", "alpha"), [(300, 0.0), (401, 0.1)])
def test_hundreds_of_interfaces_take_little_memory_and_no_time_of_the_system(folder, n, alpha):
    (folder / "deep.yaml").write_text(
        f"material:\n  name: deep\n  layers:\n{_stack(n, alpha)}"
        "incident: {theta_deg: [30]}\nslice: {rows: 9, columns: 18}\nsimulation: {rays: 2000, seed: 1}\n"
    )
    taken, system_seconds = _peak(["simulate", "deep.yaml", "--threads", 1, "-q", "-o", "deep.h5"])
    assert taken < 1e9 and system_seconds < 5.0


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell the size of a process")
def test_a_real_limit_on_address_space_is_met(folder):
    limited = (
        "import resource, sys; resource.setrlimit(resource.RLIMIT_AS, (3 * 10**9,) * 2); "
        "from goniosim_cli.main import main; sys.argv[0] = 'goniosim'; main()"
    )
    options = ["--set", "slice.rows=2000", "--set", "slice.columns=2000", "-o", "big.h5"]
    command = [sys.executable, "-c", limited, "simulate", "scene.yaml", *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 4 and "not enough memory" in done.stderr and "ulimit -v" in done.stderr
    assert sorted(os.listdir(folder)) == ["scene.yaml", "study.yaml"]
