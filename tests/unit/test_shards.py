"""Shards: which one is meant, what each of them traces, and the file that says how a study is cut."""

import itertools
import json

import pytest

from goniosim.cluster import Division, ShardPlan, array_list, parse_shard, plan_of
from goniosim.cluster.plan_file import NAME
from goniosim.engine import piece_rays
from goniosim.errors import ConfigError, ForeignFileError, NewerSchemaError, OutputError, RefusalError
from goniosim.scene import load_scenes, with_arguments
from small import STUDY

SCENES = load_scenes(STUDY)
TARGET = with_arguments(SCENES[1], {"target": 0.1})


@pytest.mark.parametrize(
    ("text", "planned", "task", "expected"),
    [
        ("3/16", None, None, (3, 16)),
        ("1/1", None, None, (1, 1)),
        ("016/16", 4, "5", (16, 16)),
        ("auto/16", None, "7", (7, 16)),
        ("auto/2", 16, "1", (1, 2)),
        ("auto", 16, "7", (7, 16)),
        ("3", 16, None, (3, 16)),
    ],
)
def test_which_shard_is_meant(text, planned, task, expected):
    # The size of the array says nothing: it may be one that reruns what is missing.
    environment = {"SLURM_ARRAY_TASK_COUNT": "2"} | ({} if task is None else {"SLURM_ARRAY_TASK_ID": task})
    assert parse_shard(text, planned, environment) == expected


@pytest.mark.parametrize(
    ("text", "task", "words"),
    [
        ("17/16", None, "--shard must be from 1/16 to 16/16 [got 17/16]"),
        ("0/16", None, "--shard must be from 1/16 to 16/16 [got 0/16]"),
        ("1/0", None, "--shard must be from 1/0 to 0/0 [got 1/0]"),
        ("auto/16", "17", "[got 17/16 (from SLURM_ARRAY_TASK_ID)]"),
        ("auto", "3", "--shard auto: how many shards are there? Write auto/16, or make a plan first"),
        *(
            (text, None, "--shard must be k/n, such as 3/16")
            for text in ("", "3/", "-1/4", "3/16/1", "x", "²/4", "1e1/16")
        ),
    ],
)
def test_what_is_no_shard(text, task, words):
    with pytest.raises(ConfigError) as caught:
        parse_shard(text, None, {} if task is None else {"SLURM_ARRAY_TASK_ID": task})
    assert words in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize("environment", [{}, {"SLURM_ARRAY_TASK_ID": "seven"}, {"SLURM_ARRAY_TASK_ID": ""}])
def test_auto_is_for_tasks_of_an_array(environment):
    with pytest.raises(RefusalError, match="this is no task of a Slurm array"):
        parse_shard("auto/16", None, environment)


@pytest.mark.parametrize(
    ("numbers", "text"), [([5, 2, 7, 6], "2,5-7"), ([1], "1"), ([2, 1, 2], "1-2"), ([1, 3, 5], "1,3,5"), ([], "")]
)
def test_numbers_as_an_array_takes_them(numbers, text):
    assert array_list(numbers) == text


@pytest.mark.parametrize("shards", [1, 2, 5, 13, 1000])
@pytest.mark.parametrize("weights", [None, [1.0, 1.0, 1.0], [1e-9, 3.0, 0.1], [1e6, 1.0, 1e6]])
@pytest.mark.parametrize("with_target", [False, True])
def test_every_piece_of_work_is_in_just_one_shard(shards, weights, with_target):
    """In the order of the shards, each in one stretch; all of a material with a target in a single one."""
    scenes = [SCENES[0], TARGET, SCENES[2]] if with_target else SCENES
    division = Division(ShardPlan.make(scenes, "study", shards, weights))
    tasks = division.all_tasks()
    assert tasks == [task for shard in range(1, shards + 1) for task in division.tasks(shard)]
    assert len({task.name for task in tasks}) == len(tasks)
    for scene in division._plan.scenes:
        mine = [task for task in tasks if task.scene == scene]
        assert [task.shard for task in mine] == sorted({task.shard for task in mine})
        if scene.simulation.target is not None:
            (task,) = mine
            assert task.is_result and task.name == "coat-0.2.h5"
            continue
        edges = [(task.first, task.end) for task in mine]
        assert edges[0][0] == 0 and edges[-1][1] == len(piece_rays(scene))
        assert all(end == first for (_, end), (first, _) in itertools.pairwise(edges))
        assert all(first < end for first, end in edges)


def test_shards_are_of_equal_length():
    """To half a piece of work at either end: a sixteenth of a material."""
    scenes = [with_arguments(scene, {"estimator": "analog"}) for scene in SCENES]
    division = Division(ShardPlan.make(scenes, "study", 7))
    rays = [division.rays(shard) for shard in range(1, 8)]
    assert sum(rays) == 30_000 and max(abs(each - 30_000 / 7) for each in rays) <= 10_000 / 16
    assert Division(ShardPlan.make([SCENES[0], TARGET], "study", 1)).rays(1) is None


def test_a_plan_is_read_as_it_was_written(tmp_path):
    plan = ShardPlan.make([*SCENES[:1], TARGET], "three-coats", 5, [2.0, 1.0])
    plan.write(tmp_path / "shards")
    assert ShardPlan.read(tmp_path / "shards") == plan
    assert plan_of(tmp_path / "shards", ShardPlan.make([*SCENES[:1], TARGET], "three-coats", 5)) == plan


def test_threads_are_no_part_of_a_plan():
    assert ShardPlan.make([with_arguments(SCENES[0], {"threads": 3})], None, 2) == ShardPlan.make(SCENES[:1], None, 2)


@pytest.mark.parametrize("shards", [0, -1, 1_000_001])
def test_how_many_shards_there_may_be(shards):
    with pytest.raises(ConfigError, match="shards must be a whole number from 1 to 1000000"):
        ShardPlan.make(SCENES, "study", shards)


@pytest.mark.parametrize(
    ("scenes", "shards", "lines"),
    [
        (SCENES, 6, ["it is cut into 5 shards, not into 6"]),
        (SCENES[:2], 5, ["coat-0.3: only there"]),
        (SCENES[::-1], 5, ["the materials stand in another order"]),
        ([with_arguments(each, {"rays": 2e4}) for each in SCENES[:1]] + SCENES[1:], 5, ["coat-0.1: 1e4 rays", "2e4"]),
        ([with_arguments(each, {"seed": 2}) for each in SCENES[:1]] + SCENES[1:], 5, ["coat-0.1: ", "seed"]),
    ],
)
def test_another_plan_is_refused_with_what_differs(tmp_path, scenes, shards, lines):
    ShardPlan.make(SCENES, "study", 5).write(tmp_path)
    before = (tmp_path / NAME).read_bytes()
    with pytest.raises(OutputError, match="holds shards of something else") as caught:
        plan_of(tmp_path, ShardPlan.make(scenes, "study", shards))
    (found,) = caught.value.details
    assert all(line in found for line in lines)
    assert (tmp_path / NAME).read_bytes() == before


def crafted(**changes):
    """A plan of two scenes, as somebody might have edited it."""
    plan = ShardPlan.make(SCENES[:2], "study", 5)
    content = {
        "filetype": "goniosim-shards",
        "schema_version": 1,
        "goniosim_version": plan.goniosim_version,
        "study": "study",
        "shards": 5,
        "weights": [1, 2],
        "scenes": [scene.to_yaml() for scene in plan.scenes],
    }
    return {key: value for key, value in {**content, **changes}.items() if value is not ...}


@pytest.mark.parametrize(
    "changes",
    [
        *({"weights": weights} for weights in (..., None, "12", [1], [1, 2, 3], [0, 1], [-1, 2], ["x", 1], [[], 1])),
        *({"weights": [1, bad]} for bad in (float("nan"), float("inf"), 1e400, 10**400, 1e-300)),
        {"weights": [1e308, 1e308]},
        *({"scenes": scenes} for scenes in (..., None, "ab", [], [1, 2], ["material: 1", "{"], ["\0", "&a [*a"])),
        {"scenes": [SCENES[0].to_yaml()] * 2},
        {"scenes": crafted()["scenes"] * 50},
        *({"shards": shards} for shards in (..., None, 0, -1, 5.0, "5", 10**7, 10**400)),
        *({"study": study} for study in (..., 5, ["x"])),
        {"goniosim_version": ...},
        {"filetype": "goniosim-result"},
        {"filetype": ...},
        {"schema_version": ...},
    ],
    ids=lambda changes: repr(changes)[:40],
)
def test_a_plan_of_a_strangers_making_gives_one_line(tmp_path, changes):
    (tmp_path / NAME).write_text(json.dumps(crafted(**changes)))
    refused(tmp_path, ForeignFileError)


def refused(folder, kind):
    with pytest.raises(kind) as caught:
        ShardPlan.read(folder)
    assert "\n" not in str(caught.value) and str(folder) in str(caught.value) and len(str(caught.value)) < 500


@pytest.mark.parametrize(
    "content", [b"", b"{", b"[1]", b"\xff\xfe", b"5", b"[" * 100_000, b'{"shards": ' + b"9" * 5000]
)
def test_what_is_no_plan_at_all(tmp_path, content):
    (tmp_path / NAME).write_bytes(content)
    refused(tmp_path, ForeignFileError)


def test_a_folder_without_a_plan(tmp_path):
    refused(tmp_path, ForeignFileError)
    (tmp_path / NAME).mkdir()
    refused(tmp_path, ForeignFileError)


def test_a_plan_of_a_newer_goniosim(tmp_path):
    (tmp_path / NAME).write_text(json.dumps(crafted(schema_version=2)))
    refused(tmp_path, NewerSchemaError)
