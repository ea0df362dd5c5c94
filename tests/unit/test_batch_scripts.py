"""The batch scripts: what they ask for, and what the one of a shard does about signals, with stand-ins for programs."""

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from goniosim.cluster.slurm import Jobs, script, scripts

ROOT = Path(script.__file__).resolve().parents[3]

JOBS = Jobs("small", Path("/a/shards"), Path("/a/shards/results"), 16, 4, 10**9, 3600.0, ())


def directives(text):
    """What stands in the lines for sbatch."""
    return dict(re.findall(r"^#SBATCH --([a-z-]+)=(.*)$", text, re.MULTILINE))


def test_what_the_scripts_ask_for():
    made = scripts(JOBS)
    asked = directives(made["shards.sbatch"])
    assert asked["array"] == "1-16" and asked["cpus-per-task"] == "4" and asked["time"] == "0-01:00:00"
    assert asked["mem"] == "1145M" and asked["signal"] == "B:USR1@120" and asked["output"].endswith("/shard-%a.log")
    assert "\n#SBATCH --requeue\n" in made["shards.sbatch"]
    assert directives(made["merge.sbatch"])["kill-on-invalid-dep"] == "yes"
    program = Path(sys.executable).with_name("goniosim")
    assert f"\ngoniosim={program}\n" in made["shards.sbatch"]
    assert made["merge.sbatch"].endswith(f"\nexec {program} merge /a/shards -o /a/shards/results\n")
    assert "{{" not in "".join(made.values())


@pytest.mark.parametrize(("walltime", "time", "notice"), [(1.0, "0-00:01:00", 15), (2e5, "2-07:34:00", 120)])
def test_times_are_those_of_slurm(walltime, time, notice):
    """In whole minutes; the notice comes in good time, also before a short one is over."""
    asked = directives(scripts(Jobs(**{**vars(JOBS), "walltime": walltime}))["shards.sbatch"])
    assert (asked["time"], asked["signal"]) == (time, f"B:USR1@{notice}")


@pytest.fixture
def task(tmp_path, monkeypatch):
    """Start the script of a shard with a stand-in for `goniosim`, which notes what it is called with."""
    noted = tmp_path / "noted"
    noted.touch()
    started = []

    def start(warmup, simulate):
        for name, text in {
            "goniosim": f'echo "$@" >> {noted}; case $1 in warmup) {warmup};; *) {simulate};; esac',
            "scontrol": f'echo scontrol "$@" >> {noted}',
        }.items():
            (tmp_path / name).write_text(f"#!/bin/bash\n{text}\n")
            (tmp_path / name).chmod(0o700)
        monkeypatch.setattr(script, "_program", lambda: tmp_path / "goniosim")
        (tmp_path / "shards.sbatch").write_text(scripts(JOBS)["shards.sbatch"])
        environment = {
            "PATH": f"{tmp_path}:/usr/bin:/bin",
            "SLURM_ARRAY_JOB_ID": "7",
            "SLURM_ARRAY_TASK_ID": "3",
        }
        started.append(subprocess.Popen(["bash", tmp_path / "shards.sbatch"], env=environment))
        return started[0]

    def wait_for(words):
        last = time.monotonic() + 60.0
        while words not in noted.read_text():
            assert time.monotonic() < last, noted.read_text()
            time.sleep(0.02)

    start.wait_for = wait_for
    start.noted = lambda: noted.read_text().splitlines()
    yield start
    for process in started:
        process.kill()
        process.wait()


DONE = ["warmup /a/shards", "simulate /a/shards --shard auto"]
AGAIN = "scontrol requeue 7_3"
# Tells that it is ready for signals.
WORK = "trap 'exit 75' USR1 TERM; echo ready >> {noted}; while :; do sleep 0.02; done"


def test_a_shard_that_is_done(task):
    assert task("true", "exit 0").wait() == 0
    assert task.noted() == DONE


@pytest.mark.parametrize("code", [3, 137])
def test_an_error_is_passed_on(task, code):
    assert task("exit 1", f"exit {code}").wait() == code
    assert task.noted() == DONE


@pytest.mark.parametrize(("which", "after"), [(signal.SIGUSR1, [AGAIN]), (signal.SIGTERM, [])])
def test_a_signal_is_passed_on_and_a_warning_leads_back_into_the_queue(task, tmp_path, which, after):
    process = task("true", WORK.format(noted=tmp_path / "noted"))
    task.wait_for("ready")
    process.send_signal(which)
    assert process.wait() == 75
    assert task.noted() == [*DONE, "ready", *after]


@pytest.mark.parametrize(("which", "after"), [(signal.SIGUSR1, [AGAIN]), (signal.SIGTERM, [])])
def test_told_to_stop_while_it_compiles_it_begins_no_shard(task, tmp_path, which, after):
    process = task(f"echo ready >> {tmp_path}/noted; exec sleep 60", "exit 0")
    task.wait_for("ready")
    process.send_signal(which)
    assert process.wait() == 75
    assert task.noted() == [DONE[0], "ready", *after]


def test_the_templates_of_the_repository_are_the_packaged_ones():
    packaged = sorted((ROOT / "goniosim" / "cluster" / "slurm").glob("*.sbatch"))
    assert len(packaged) == 2
    for path in packaged:
        assert (ROOT / "configs" / "cluster" / path.name).read_bytes() == path.read_bytes()
