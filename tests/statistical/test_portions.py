"""A simulation in portions, joined, is the simulation in one go: to the same bits, however it was cut."""

import itertools
import threading

import pytest

from goniosim.engine import join_portions, piece_rays, simulate, trace_portion
from goniosim.engine.drive import Drive
from goniosim.engine.plan import make_plan
from goniosim.engine.portion import Portion
from goniosim.scene import with_arguments
from reference.scenes import METAL, NARROW, PLASTIC, SLAB, make_scene
from sameness import content

CASES = {
    "analog": (METAL, {"orders": 2}, {"rays": 20_000, "estimator": "analog"}),
    "connection": (PLASTIC, {}, {"rays": 131_072}),
    "operator": (METAL, {}, {"rays": 800_000}),
    "split": (NARROW, {}, {"rays": 300_000}),
    "two estimators": (SLAB, {}, {"rays": 300_000}),
}


def scene_of(case):
    layers, orders, asked = CASES[case]
    return with_arguments(make_scene(layers, [10.0, 70.0], rows=9, columns=36, **orders), asked)


def portions(scene, n, **given):
    """States of n portions of equally many pieces, or a few more or less."""
    edges = [len(piece_rays(scene)) * k // n for k in range(n + 1)]
    return [trace_portion(scene, a, b, **given).state for a, b in itertools.pairwise(edges) if b > a]


@pytest.fixture(scope="module")
def wholes():
    """Plain runs, by the name of the case."""
    return {case: simulate(scene_of(case)) for case in CASES}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("n", [1, 2, 5, pytest.param(13, marks=pytest.mark.slow)])
def test_joined_to_the_same_bits(wholes, case, n):
    scene = scene_of(case)
    found = join_portions(scene, portions(scene, n))
    assert found.status == "complete" and content(found) == content(wholes[case])


@pytest.mark.parametrize("case", ["operator", "connection"])
def test_all_light_paths_are_told_at_the_very_end_only(case):
    """Whoever is told of all takes a portion for whole; the last work may be on the bias of nodes, without paths."""
    scene, told = scene_of(case), []
    portion = Portion(make_plan(scene), scene.simulation, 0, 1)
    drive = Drive(1, threading.Event(), lambda done, total: None)
    portion.run(drive, lambda portion: told.append((portion.rays == portion.total_rays, portion.finished)))
    assert len(told) > 1 and told[-1] == (True, True) and not any(any(each) for each in told[:-1])
