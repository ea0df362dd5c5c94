"""Portions of a stranger's making, with digests that agree: one line that names the file, and never a wrong number."""

import copy
import itertools
from dataclasses import replace

import numpy as np
import pytest

from crafting import arrays, changed
from goniosim.cluster import Division, ShardPlan, merge, run_shard
from goniosim.engine import join_portions, piece_rays, simulate, trace_portion
from goniosim.engine.packing import pack, unpack
from goniosim.errors import UnusableResultError
from goniosim.store import read_portion, write_portion
from reference.scenes import dielectric, lambert, make_scene
from sameness import content

LAYERS = [dielectric(1.5, 0.1), lambert(0.5)]
SCENES = {
    "analog": make_scene(LAYERS, [10.0, 70.0], rows=6, columns=12, rays=4000, estimator="analog"),
    "connection": make_scene(LAYERS, [10.0, 70.0], rows=6, columns=12, rays=131_072),
}


@pytest.fixture(scope="module", params=["analog", pytest.param("connection", marks=pytest.mark.slow)])
def made(request):
    """A scene, the pieces of its portions, and what they hold: the second begins in mid-direction."""
    scene = SCENES[request.param]
    count = len(piece_rays(scene))
    edges = [0, count // 3, 3 * count // 4, count]
    return scene, edges, [unpack(trace_portion(scene, *each).state) for each in itertools.pairwise(edges)]


def refused(made, number, tree):
    """Neither joined nor gone on from, whatever is made of it."""
    scene, edges, trees = made
    states = [pack(tree if i == number else each) for i, each in enumerate(trees)]
    with pytest.raises(UnusableResultError) as caught:
        join_portions(scene, states)
    # What pretends to be a piece of a later one makes that one the second.
    assert caught.value.number >= number and "\n" not in str(caught.value)
    with pytest.raises(UnusableResultError):
        trace_portion(scene, edges[number], edges[number + 1], resume=pack(tree))


def test_they_are_right_as_they_are(made):
    scene, _, trees = made
    assert content(join_portions(scene, map(pack, trees))) == content(simulate(scene))


@pytest.mark.parametrize("number", [0, 1])
def test_arrays_of_other_shapes_and_types(made, number):
    """Kernels would read behind their ends."""
    tree, tried = made[2][number], 0
    for path, array in arrays(tree):
        if not array.size:
            continue
        nan = np.full_like(array, np.nan)
        # One kind after the other: each takes a join.
        wrong = [array.reshape(-1)[:-1], array[..., None], array.astype(np.float32), array.tolist(), None, "x", nan]
        refused(made, number, changed(tree, path, wrong[tried % len(wrong)]))
        tried += 1
    assert tried >= 2


NUMBERS = {
    "run": (-1, 7, "x", None),
    "direction": (-1, 7, None),
    "piece": (-1, 10**6, 10**30, "x"),
    "works": (-1, 0, 10**6, "x", None),
    "seconds": ("x", None, -1.0),
    "sums": (None, [], 5),
}


@pytest.mark.parametrize(("name", "value"), [(name, value) for name, values in NUMBERS.items() for value in values])
def test_numbers_out_of_range_or_none(made, name, value):
    number = 1
    records = made[2][number]["records"]
    refused(made, number, changed(made[2][number], ("records", len(records) - 1, name), value))


@pytest.mark.parametrize("name", ["run", "direction", "piece", "works", "sums", "seconds"])
def test_what_is_missing(made, name):
    tree = copy.deepcopy(made[2][1])
    del tree["records"][0][name]
    refused(made, 1, tree)


def test_the_same_piece_twice(made):
    tree = copy.deepcopy(made[2][1])
    tree["records"].append(tree["records"][-1])
    refused(made, 1, tree)
    scene, _, trees = made
    for states in ([trees[0], trees[0]], [trees[0], trees[1], trees[1]], [trees[1], trees[0]]):
        with pytest.raises(UnusableResultError, match="the same piece of work is there twice"):
            join_portions(scene, map(pack, states))


def integers(tree, path=()):
    """Ways to the whole numbers of a tree, with them."""
    if isinstance(tree, int) and not isinstance(tree, bool):
        yield path, tree
    elif isinstance(tree, dict | list):
        for key, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
            yield from integers(value, (*path, key))


@pytest.mark.slow
@pytest.mark.parametrize("number", [0, 1, 2])
def test_every_number_that_counts_something(made, number):
    """One more of anything but events, which nothing relies on, contradicts the rest."""
    tree = made[2][number]
    relied = ("version", "pieces", "done", "events", "checkpoints")
    for path, value in integers(tree):
        if not any(name in path for name in relied):
            refused(made, number, changed(tree, path, value + 1))


def test_what_a_portion_goes_on_from(made):
    scene, edges, trees = made
    for name, values in {"done": (-1, 0, 10**6, None, "x"), "pieces": ([0, 1], None, [edges[1] + 1, edges[2]])}.items():
        for value in values:
            with pytest.raises(UnusableResultError):
                trace_portion(scene, edges[1], edges[2], resume=pack({**trees[1], name: value}))


@pytest.fixture
def folder(tmp_path):
    """A folder with two shards of a scene."""
    plan = ShardPlan.make([SCENES["analog"]], None, 2)
    plan.write(tmp_path)
    for shard in (1, 2):
        run_shard(tmp_path, shard, threads=1)
    return tmp_path


def edit(folder, shard, change):
    """Change the state of a shard's portion, and sign it anew."""
    (task,) = Division(ShardPlan.read(folder)).tasks(shard)
    portion, state = read_portion(task.path(folder))
    portion, tree = change(portion, unpack(state))
    write_portion(portion, pack(tree), task.path(folder))
    return task.path(folder)


def test_merge_names_the_file_and_the_shard(folder):
    def twice(portion, tree):
        return portion, {**tree, "records": [*tree["records"], tree["records"][-1]]}

    path = edit(folder, 2, twice)
    with pytest.raises(UnusableResultError) as caught:
        list(merge(folder, folder / "merged.h5"))
    assert str(caught.value).startswith(f"{path}: ") and str(caught.value).endswith("run its shard again: --array=2")
    assert not (folder / "merged.h5").exists()


def test_what_says_that_it_is_whole_and_is_not(folder):
    edit(folder, 2, lambda portion, tree: (portion, {**tree, "records": tree["records"][:-1]}))
    with pytest.raises(UnusableResultError, match="its shards hold less than they say"):
        list(merge(folder, folder / "merged.h5"))
    assert not (folder / "merged.h5").exists()


def test_what_cannot_be_gone_on_from(folder):
    def partial(portion, tree):
        return replace(portion, done_rays=portion.total_rays - 1), {**tree, "done": 10**6}

    path = edit(folder, 2, partial)
    with pytest.raises(
        UnusableResultError, match="pieces of work where there are 16; remove it, to begin anew"
    ) as caught:
        run_shard(folder, 2, threads=1)
    assert str(caught.value).startswith(f"{path}: ")
