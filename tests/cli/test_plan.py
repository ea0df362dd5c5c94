"""`goniosim plan`: what it predicts, into how many shards it cuts, and what it writes."""

import shlex
import subprocess

import pytest

from goniosim.cluster import Division, ShardPlan, outlook, run_shard
from goniosim.engine import piece_rays
from goniosim.scene import parse_scene
from small import SCENE

# A folder that no shell and no batch system takes without quotes.
AWKWARD = 'it\'s "so" 100 %a #1 $HOME'


@pytest.fixture(autouse=True)
def short_probe(monkeypatch):
    monkeypatch.setattr("goniosim.report.simulation.forecast.PROBE", 0.01)
    monkeypatch.setattr("goniosim.report.simulation.forecast.PROBE_STUDY", 0.01)


def test_a_study_is_predicted_and_nothing_written(folder, goniosim):
    before = sorted(folder.iterdir())
    code, out, err = goniosim("plan", "study.yaml", "--cpus", 3)
    assert (code, err) == (0, "")
    assert "tasks with 3 processors" in out and out.count("coat-0.") == 3
    for line in ("time     ", "memory   at most ", "disk     at most ", "shards   1, each about "):
        assert f"\n  {line}" in out
    assert sorted(folder.iterdir()) == before


def test_of_a_scene_the_effects_are_told(folder, goniosim):
    code, out, _ = goniosim("plan", "scene.yaml", "--rays", "1e12", "--shards", 7, "--walltime", "10m")
    assert code == 0 and "absorption" in out and "shards   7, each about" in out
    assert "Warning: a shard takes longer than a task may" in out


def test_a_plan_and_its_scripts_are_written(folder, goniosim):
    place = folder / AWKWARD
    code, out, err = goniosim("plan", "study.yaml", "-o", place, "--shards", 2, "--", "--partition", "long", "-A", "me")
    assert (code, err) == (0, "")
    plan = ShardPlan.read(place)
    assert (plan.study, plan.shards, len(plan.weights)) == ("three-coats", 2, 3)
    assert sorted(path.name for path in place.iterdir()) == ["logs", "merge.sbatch", "plan.json", "shards.sbatch"]
    for name in ("shards.sbatch", "merge.sbatch"):
        assert subprocess.run(["bash", "-n", place / name]).returncode == 0
        assert "\n#SBATCH --partition long -A me\n" in (place / name).read_text()
    first, second = out.splitlines()[-2:]
    assert first == f"  job=$(sbatch --parsable {shlex.quote(f'{place}/shards.sbatch')})"
    assert second == f"  sbatch --dependency=afterany:${{job%%;*}} {shlex.quote(f'{place}/merge.sbatch')}"


def test_the_same_plan_is_written_again_and_another_refused(folder, goniosim):
    assert goniosim("plan", "study.yaml", "-o", "shards", "--shards", 2)[0] == 0
    before = (folder / "shards" / "plan.json").read_bytes()
    assert "shards   2, " in goniosim("plan", "study.yaml", "-o", "shards")[1]
    for options in (["--shards", 3], ["--rays", "2e4"], ["--set", "slice.rows=7"]):
        code, _, err = goniosim("plan", "study.yaml", "-o", "shards", *options)
        assert code == 4 and "holds shards of something else" in err
    assert (folder / "shards" / "plan.json").read_bytes() == before


def test_what_is_no_option_of_sbatch_is_refused(folder, goniosim):
    code, _, err = goniosim("plan", "study.yaml", "scene.yaml")
    assert code == 2 and "unexpected extra argument (scene.yaml); options of sbatch stand behind --" in err


def _expected(seconds, rays=1e12):
    scene = parse_scene(SCENE, overrides=[f"simulation.rays={rays}"])
    return outlook.Expected(scene, 1e7, seconds, 10**9, 10**6, None)


@pytest.mark.parametrize(
    ("seconds", "walltime", "shards"),
    [
        # Half an hour fits into an hour, two hours into four of them with room to spare.
        (1800.0, 3600.0, 1),
        (7200.0, 3600.0, 4),
        # No more than start-up is worth, nor than Slurm takes.
        (600.0, 60.0, 10),
        (1e9, 3600.0, 1000),
    ],
)
def test_shards_fill_their_time_and_leave_room(seconds, walltime, shards):
    assert outlook._recommended([_expected(seconds / 20)] * 20, walltime) == shards


def test_no_more_shards_than_pieces_of_work():
    expected = _expected(1e6, rays=2e6)
    assert outlook._recommended([expected], 60.0) == len(piece_rays(expected.scene)) < 20


def test_a_time_that_nobody_knows_is_taken_for_the_mean():
    assert outlook._weights([_expected(10.0), _expected(None), _expected(30.0)]) == [10.0, 20.0, 30.0]
    assert outlook._weights([_expected(None)]) == [1.0]


@pytest.mark.parametrize("estimator", ["analog", "split"])
def test_shards_leave_no_more_than_is_predicted(tmp_path, estimator):
    scene = parse_scene(SCENE, overrides=["simulation.rays=3e5", f"simulation.estimator={estimator}"])
    plan = ShardPlan.make([scene], None, 3)
    plan.write(tmp_path)
    for number in (1, 2, 3):
        run_shard(tmp_path, number, threads=1)
    held = sum(task.path(tmp_path).stat().st_size for task in Division(plan).all_tasks())
    assert held < outlook._left(plan) < 5 * held


def test_the_folder_of_a_plan_stands_for_what_it_was_made_of(folder, goniosim, monkeypatch):
    ShardPlan.make([parse_scene(SCENE)], None, 2).write("shards")
    (folder / "scene.yaml").unlink()
    assert goniosim("warmup", "shards")[0] == 0
    monkeypatch.setenv("SLURM_ARRAY_TASK_ID", "2")
    assert "shard 2 of 2: " in goniosim("simulate", "shards", "--shard", "auto", "--threads", 1)[1]
    code, _, err = goniosim("simulate", "shards", "--shard", 1, "--rays", "5e3")
    assert code == 3 and "shards: --rays 5000: what is planned cannot be changed" in err
    code, _, err = goniosim("simulate", ".", "--shard", 1)
    assert code == 5 and "plan.json is missing" in err


@pytest.mark.parametrize("name", ["back\\slash", "line\nbreak"])
def test_a_folder_that_no_script_can_name_is_refused(folder, goniosim, name):
    code, _, err = goniosim("plan", "study.yaml", "-o", name)
    assert code == 4 and "cannot stand in a batch script" in err and err.count("\n") == 1
    assert not (folder / name).exists()
