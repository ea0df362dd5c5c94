"""A study as a job array of a real Slurm: killed, requeued, out of time, and merged to the bits of one plain run."""

import json
import os
import re
import signal
from pathlib import Path

import h5py
import numpy as np
import pytest
from click.testing import CliRunner
from goniosim_cli.main import main

pytestmark = pytest.mark.cluster

# A minute for each of four shards on one processor: as long as the shortest time limit of Slurm.
STUDY = """\
study:
  name: two-coats
  cross:
    alpha: [0.1, 0.3]
  material:
    name: coat-${alpha}
    layers:
      - interface: {type: dielectric, eta: 1.5, alpha: "${alpha}"}
      - interface: {type: conductor, eta: 1.45, kappa: 1.0, alpha: 0.2}
incident: {theta_deg: [30, 60]}
slice: {rows: 6, columns: 12}
simulation: {rays: 6e8, seed: 1, estimator: split}
"""


def call(*arguments):
    """Call the command in this process: exit code, and what it prints."""
    outcome = CliRunner().invoke(main, [str(argument) for argument in arguments])
    return outcome.exit_code, outcome.output


def processes(folder, shard):
    """Numbers of the processes that trace a shard, and not those of its batch script."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0")
            task = f"SLURM_ARRAY_TASK_ID={shard}".encode() in (entry / "environ").read_bytes().split(b"\0")
        except OSError:
            continue
        if task and b"simulate" in words and os.fsencode(folder) in words:
            found.append(int(entry.name))
    return found


TIMES = ("cost/seconds", "cost/cpu_seconds")


def contents(path):
    """All datasets of a result file but times, and the attributes that say what it is of."""
    found = {}
    with h5py.File(path) as file:

        def note(name, item):
            if isinstance(item, h5py.Dataset) and not name.startswith(
                ("checksums/", "cost/seconds", "cost/cpu_seconds")
            ):
                found[name] = np.asarray(item[()]).tobytes()

        file.visititems(note)
        for name in ("config_yaml", "config_hash", "status", "seed"):
            found[f"@{name}"] = str(file.attrs[name])
    return found


def jobs_in(text):
    """Numbers of the two jobs that `goniosim submit` tells."""
    return re.findall(r"job (\d+)", text)


def test_what_happens_to_tasks_leaves_no_trace(slurm, tmp_path):
    """One is killed, one requeued, all meet their time limit: the merged files are those of a plain run."""
    (tmp_path / "study.yaml").write_text(STUDY)
    folder = tmp_path / 'it\'s a "folder"'
    asked = ("submit", tmp_path / "study.yaml", "--slurm", "-o", folder)
    code, out = call(*asked, "--shards", 4, "--walltime", "1m", "--cpus", 1, "--", "--comment=two words")
    assert code == 0 and out.startswith("4 shards of 4 submitted as job "), out
    job, merge = jobs_in(out)
    assert "Comment=two words" in slurm.run("scontrol", "show", "job", merge)

    def log(shard):
        path = folder / "logs" / f"shard-{shard}.log"
        return path.read_text() if path.exists() else ""

    # After the first time that it was told to stop.
    slurm.wait(lambda: "goes on from" in log(1), "shard 1 does not go on", 240.0)
    for number in processes(folder, 1):
        os.kill(number, signal.SIGKILL)
    slurm.wait(lambda: slurm.states(job)[f"{job}_1"] == "FAILED", "shard 1 does not fail")
    slurm.wait(lambda: processes(folder, 3), "shard 3 does not start", 240.0)
    slurm.run("scontrol", "requeue", f"{job}_3")
    assert slurm.finish(job, 900.0) == {f"{job}_1": "FAILED", **{f"{job}_{k}": "COMPLETED" for k in (2, 3, 4)}}
    for shard in (1, 2, 4):
        assert "stopped by SIGUSR1; the same command goes on" in log(shard) and "goes on from" in log(shard)
    assert slurm.finish(merge) == {merge: "FAILED"}
    assert "--array=1 " in (folder / "logs" / "merge.log").read_text() and not (folder / "results").exists()

    found = json.loads(call("status", folder, "--json")[1])
    assert (found["done"], found["stopped"], found["running"]) == ([2, 3, 4], [1], [])
    assert found["rays_planned"] > found["rays_done"] > 0.7 * found["rays_planned"]
    code, out = call("submit", folder, "--slurm")
    assert code == 0 and out.startswith("1 shard of 4 submitted as job "), out
    job, merge = jobs_in(out)
    assert slurm.finish(job, 600.0) == {f"{job}_1": "COMPLETED"}
    assert slurm.finish(merge) == {merge: "COMPLETED"}
    assert "all shards are done: nothing to submit" in call(*asked)[1]

    assert call("simulate", tmp_path / "study.yaml", "-o", tmp_path / "plain", "-q")[0] == 0
    names = sorted(path.name for path in (tmp_path / "plain").iterdir())
    assert names == sorted(path.name for path in (folder / "results").iterdir()) == ["coat-0.1.h5", "coat-0.3.h5"]
    for name in names:
        assert contents(folder / "results" / name) == contents(tmp_path / "plain" / name)


def test_a_task_that_is_cancelled_stays_away(slurm, tmp_path):
    """It keeps what it has, and does not queue again."""
    (tmp_path / "study.yaml").write_text(STUDY)
    folder = tmp_path / "shards"
    code, out = call("submit", tmp_path / "study.yaml", "--slurm", "-o", folder, "--shards", 2, "--cpus", 1)
    assert code == 0, out
    job, merge = jobs_in(out)
    log = folder / "logs" / "shard-1.log"
    slurm.wait(lambda: log.exists() and " % of " in log.read_text(), "shard 1 does not trace", 120.0)
    slurm.run("scancel", job)
    assert set(slurm.finish(job).values()) == {"CANCELLED"}
    assert slurm.finish(merge) == {merge: "FAILED"}
    found = json.loads(call("status", folder, "--json")[1])
    assert 1 in found["stopped"] and 0 < found["rays_done"] < found["rays_planned"]


def test_what_slurm_refuses_is_said_in_a_line(slurm, tmp_path):
    (tmp_path / "study.yaml").write_text(STUDY)
    asked = ("submit", tmp_path / "study.yaml", "--slurm", "-o", tmp_path / "shards", "--shards", 2)
    code, out = call(*asked, "--", "--partition=nowhere")
    assert code == 10 and out.count("\n") == 1
    assert "sbatch refuses shards.sbatch: " in out and "invalid partition" in out
