"""`goniosim submit`: what is handed to sbatch, a stand-in here; a real one is in tests/cluster."""

import os
import stat

import pytest

from goniosim.cluster import ShardPlan, run_shard
from goniosim.cluster.tracing import error_path


@pytest.fixture(autouse=True)
def short_probe(monkeypatch):
    monkeypatch.setattr("goniosim.report.simulation.forecast.PROBE", 0.01)
    monkeypatch.setattr("goniosim.report.simulation.forecast.PROBE_STUDY", 0.01)


@pytest.fixture
def sbatch(tmp_path_factory, monkeypatch):
    """A stand-in that notes what it is called with; returns what was noted, a list of words for each call."""
    home = tmp_path_factory.mktemp("bin")
    noted = home / "calls"

    def answer(text):
        program = home / "sbatch"
        program.write_text(f"#!/bin/bash\nprintf '%s\\t' \"$@\" >> {noted}\necho >> {noted}\n{text}\n")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)

    answer(f"wc -l < {noted}")
    monkeypatch.setenv("PATH", f"{home}{os.pathsep}{os.environ['PATH']}")

    def calls():
        found = [line.split("\t")[:-1] for line in noted.read_text().splitlines()]
        noted.write_text("")
        return found

    calls.answer = answer
    noted.touch()
    return calls


SUBMIT = ("submit", "study.yaml", "--slurm", "-o", "my shards", "--shards", 3)


def test_an_array_and_its_merge(folder, goniosim, sbatch):
    code, out, err = goniosim(*SUBMIT, "--", "--partition=long")
    assert (code, err) == (0, "")
    assert out.startswith("3 shards of 3 submitted as job 1, their merge as job 2\n")
    assert "goniosim status 'my shards'\n" in out
    home = str(folder / "my shards")
    assert sbatch() == [
        ["--parsable", "--array=1-3", f"{home}/shards.sbatch"],
        ["--parsable", "--dependency=afterany:1", f"{home}/merge.sbatch"],
    ]
    assert "#SBATCH --partition=long\n" in (folder / "my shards" / "shards.sbatch").read_text()


def test_only_what_is_missing_is_submitted_again(folder, goniosim, sbatch):
    goniosim(*SUBMIT)
    sbatch()
    run_shard("my shards", 2, threads=1)
    error_path("my shards", 3, 3).write_text("no space left\n")
    for command in (("submit", "my shards", "--slurm"), SUBMIT):
        code, out, _ = goniosim(*command, "--", "--time=2:00:00")
        assert code == 0 and "2 shards of 3 submitted" in out
        assert sbatch()[0][:3] == ["--parsable", "--array=1,3", "--time=2:00:00"]
    for number in (1, 3):
        run_shard("my shards", number, threads=1)
    code, out, _ = goniosim(*SUBMIT)
    assert code == 0 and sbatch() == []
    assert out.endswith("goniosim merge 'my shards' -o 'my shards/results'\n") and "nothing to submit" in out


def test_what_a_disk_has_damaged_is_submitted_again(folder, goniosim, sbatch):
    """As the merge says, which looks at every byte."""
    goniosim(*SUBMIT)
    sbatch()
    for number in (1, 2, 3):
        run_shard("my shards", number, threads=1)
    path = next((folder / "my shards").glob("*00002-of*.h5"))
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    assert goniosim("merge", "my shards", "-o", "merged")[0] == 8
    code, out, _ = goniosim("submit", "my shards", "--slurm")
    assert code == 0 and "1 shard of 3 submitted" in out and sbatch()[0][1] == "--array=2"


def test_what_is_planned_cannot_be_changed(folder, goniosim, sbatch):
    goniosim(*SUBMIT)
    code, _, err = goniosim("submit", "my shards", "--slurm", "--rays", "1e5", "--walltime", "2h")
    assert code == 2 and "has its plan already, which takes no --rays, --walltime" in err
    assert goniosim(*SUBMIT, "--cpus", 2)[0] == 2
    code, _, err = goniosim(*SUBMIT, "--rays", "2e4")
    assert code == 4 and "holds shards of something else" in err
    assert len(sbatch()) == 2


def test_without_a_batch_system(folder, goniosim, monkeypatch):
    code, _, err = goniosim("submit", "study.yaml", "-o", "shards")
    assert code == 2 and "Say --slurm" in err
    monkeypatch.setenv("PATH", str(folder))
    code, _, err = goniosim(*SUBMIT)
    assert code == 10 and err.count("\n") == 1
    assert "there is no sbatch here" in err and "--shard 1, and so on" in err
    assert ShardPlan.read("my shards").shards == 3
    assert goniosim("submit", "study.yaml", "--slurm")[0] == 10
    assert ShardPlan.read("three-coats.shards").study == "three-coats"


def test_what_sbatch_refuses_is_passed_on(folder, goniosim, sbatch):
    sbatch.answer("echo 'sbatch: error: invalid partition' >&2; exit 1")
    code, _, err = goniosim(*SUBMIT)
    assert code == 10 and "sbatch refuses shards.sbatch: sbatch: error: invalid partition\n" in err
    assert len(sbatch()) == 1
    sbatch.answer('case "$*" in *merge*) echo no >&2; exit 1;; *) echo "7;cluster";; esac')
    code, _, err = goniosim(*SUBMIT)
    assert (
        code == 10 and "the shards are submitted as job 7, but not their merge: sbatch refuses merge.sbatch: no" in err
    )
    assert sbatch()[1][1] == "--dependency=afterany:7"
