"""`goniosim status`: shards that are done, stopped, missing or failed, what they hold and what is left."""

import json

import pytest

from goniosim.claims import Claim
from goniosim.cluster import Division, ShardPlan, run_shard
from goniosim.cluster.status import Shard, Stage, Status, look
from goniosim.cluster.tracing import error_path
from goniosim.scene import load_scene


@pytest.fixture
def planned(folder):
    """A folder of five shards, of which the last has nothing to do."""
    scenes = [load_scene("scene.yaml", ["simulation.rays=2e5", "simulation.estimator=split"])]
    ShardPlan.make(scenes, None, 5).write("shards")
    return folder / "shards"


def parsed(goniosim, *arguments):
    code, out, err = goniosim("status", *arguments, "--json")
    assert code == 0, err
    return json.loads(out)


def test_nothing_is_there_yet(planned, goniosim):
    found = parsed(goniosim, "shards")
    assert (found["name"], found["shards"], found["missing"]) == ("small", 5, [1, 2, 4, 5])
    assert found["rays_done"] == 0 and found["rays_planned"] >= 2e5 and found["seconds_left"] is None
    out = goniosim("status", "shards")[1]
    assert out.startswith("small: 5 shards\n") and "  missing      4   1-2,4-5\n" in out
    assert "  left     nobody can tell yet\n" in out


def test_every_state_has_a_line(planned, goniosim):
    run_shard("shards", 1, threads=1)
    run_shard("shards", 4, threads=1)
    (cut,) = planned.glob("*00004-of*.h5")
    cut.write_bytes(cut.read_bytes()[:-100])
    error_path("shards", 5, 5).write_text("goniosim: \x1b[31mno space\nleft\n")
    # An error of a shard that went well in the end.
    error_path("shards", 1, 5).write_text("of before")
    found = parsed(goniosim, "shards")
    assert (found["done"], found["missing"], found["failed"]) == ([1, 3], [2], [4, 5])
    assert set(found["errors"]) == {"4", "5"} and "cut off" in found["errors"]["4"]
    assert 0 < found["rays_done"] < found["rays_planned"]
    out = goniosim("status", "shards")[1]
    assert "  done         2   1,3\n" in out and "  failed       2   4-5\n" in out
    assert "    5: goniosim: \\x1b[31mno space left\n" in out


def test_a_shard_that_somebody_is_at_work_on_runs(planned, goniosim):
    """Whatever it said before, and only as long as its process lives."""
    error_path("shards", 2, 5).write_text("of before")
    (task,) = Division(ShardPlan.read("shards")).tasks(2)
    with Claim(task.path(planned)):
        found = parsed(goniosim, "shards")
        assert (found["running"], found["failed"]) == ([2], [])
    assert parsed(goniosim, "shards")["failed"] == [2]


def test_merged_results_tell_their_noise(planned, goniosim):
    for number in range(1, 6):
        run_shard("shards", number, threads=1)
    assert "  left     nothing: merge them\n" in goniosim("status", "shards")[1]
    # No shard has a whole round.
    assert parsed(goniosim, "shards")["noise"] is None
    assert goniosim("merge", "shards", "-o", "shards/results/small.h5", "-q")[0] == 0
    found = parsed(goniosim, "shards")
    assert found["seconds_left"] == 0.0 and found["rays_done"] == found["rays_planned"]
    assert found["results"]["small"]["status"] == "complete" and 0.0 < found["results"]["small"]["noise"] < 0.1
    out = goniosim("status", "shards")[1]
    assert "  left     nothing\n" in out and "\nMerged, in shards/results\n" in out


def test_the_noise_of_shards_is_that_of_their_finished_rounds(folder, goniosim):
    """Others have the rest of a direction, and make it smaller."""
    scene = load_scene("scene.yaml", ["simulation.rays=1.2e6", "simulation.estimator=split"])
    for count in (1, 3):
        ShardPlan.make([scene], None, count).write(f"in-{count}")
        for number in range(1, count + 1):
            run_shard(f"in-{count}", number, threads=1)
    goniosim("merge", "in-1", "-o", "in-1/results/small.h5", "-q")
    whole, cut = (parsed(goniosim, f"in-{count}") for count in (1, 3))
    reached = whole["results"]["small"]["noise"]
    assert whole["noise"] == pytest.approx(reached, rel=1e-3) and cut["noise"] > 1.2 * reached
    assert f"  noise    at most {cut['noise']:.2g} sr^-1/2" in goniosim("status", "in-3")[1]


def test_a_folder_without_a_plan_is_an_error(folder, goniosim):
    code, _, err = goniosim("status", ".")
    assert code == 5 and "plan.json is missing" in err


def _shard(stage, done, total, seconds):
    return Shard(1, stage, 0, 0, done, total, seconds, None, "")


def test_what_is_left_follows_from_the_rate_of_what_is_done():
    """Also of what is half done; of results without a time only what they leave."""
    shards = [_shard(Stage.DONE, 10.0, 10.0, 30), _shard(Stage.STOPPED, 5.0, 10.0, 15), _shard(Stage.DONE, 7.0, 7.0, 0)]
    status = Status(None, [*shards, _shard(Stage.MISSING, 0.0, 10.0, 0)])
    assert status.seconds_left(status.shards) == pytest.approx(45.0)
    assert status.seconds_left(status.of(Stage.MISSING)) == pytest.approx(30.0)
    assert status.seconds_left(status.of(Stage.DONE)) == 0.0


def test_what_stopped_and_what_a_target_decides(folder, goniosim):
    """A scene with a target is of one shard, and counts by its predicted time alone."""
    goniosim("simulate", "scene.yaml", "--shard", "2/2", "-o", "shards", "--target", "20%", "-q")
    found = look("shards")
    stages = [shard.stage for shard in found.shards]
    assert stages == [Stage.DONE, Stage.DONE] and sum(shard.total_work for shard in found.shards) == 1.0
    assert sum(shard.total_rays for shard in found.shards) == 0
