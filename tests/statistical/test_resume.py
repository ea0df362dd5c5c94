"""An interrupted session goes on to the same bits, wherever it was interrupted and whatever decided on its way."""

import threading

import numpy as np
import pytest

from goniosim.engine.drive import Drive
from goniosim.engine.packing import pack, unpack
from goniosim.engine.plan import make_plan
from goniosim.engine.session import Session
from goniosim.scene import with_arguments
from reference.scenes import METAL, NARROW, PLASTIC, SLAB, make_scene

# What `auto` does with the fewest paths for replicates, in a round of its own for each; independent paths in sixteen
# units for each direction.
CASES = {
    "analog": (METAL, {"orders": 2}, {"rays": 20_000, "estimator": "analog"}),
    "connection": (PLASTIC, {}, {"rays": 131_072}),
    "operator": (METAL, {}, {"rays": 300_000}),
    "split": (NARROW, {}, {"rays": 300_000}),
    "two estimators": (SLAB, {}, {"rays": 300_000}),
    "target": (NARROW, {}, {"target": 0.02, "estimator": "split"}),
    "target of independent paths": (PLASTIC, {}, {"target": 0.2}),
    "target, two estimators": (SLAB, {}, {"target": 0.01}),
}
SOME_SLOW = [pytest.param(name, marks=[pytest.mark.slow] if "two" in name else []) for name in CASES]


def scene_of(case):
    layers, orders, asked = CASES[case]
    return with_arguments(make_scene(layers, [10.0, 70.0], rows=9, columns=36, **orders), asked)


def run(scene, threads=2, checkpoint=None, resumed=None, stop=None):
    drive = Drive(threads, stop or threading.Event(), lambda done, total: None)
    session = Session(make_plan(scene), scene.simulation, drive, checkpoint, resumed)
    session.run()
    return session


def content(session):
    """Everything but times, as bytes."""
    found = []
    for one in session.runs:
        for direction in range(len(one.rays)):
            tree = one.state(direction)
            spent = tree["spending"]
            tree["spending"] = [spent["events"], [row[0] for row in spent["checkpoints"]]]
            found.append(tree)
    tables = [np.array(parts) for parts in session.audit.ledgers]
    return pack([found, tables, session.rays, session.reached, [str(choice) for choice in session.choices]])


class States:
    """Those after the pieces of work with some numbers."""

    def __init__(self):
        self.found = []

    def __call__(self, session):
        self.found.append(pack(session.state()))


@pytest.mark.parametrize("case", SOME_SLOW)
def test_from_any_checkpoint_to_the_same_bits(case):
    """From the first, the last and some between, on one thread and on three."""
    scene, states = scene_of(case), States()
    whole = run(scene, checkpoint=states)
    assert len(states.found) > 4 and whole.finished and whole.left is None
    chosen = {0, 1, len(states.found) // 2, len(states.found) - 1}
    for number in chosen:
        again = run(scene, 1 + 2 * (number % 2), resumed=unpack(states.found[number]))
        assert content(again) == content(whole)


@pytest.mark.parametrize("case", SOME_SLOW)
def test_stopped_again_and_again(case):
    """After every third piece: what is left each time is more than before, and leads to the same bits."""
    scene = scene_of(case)
    whole, left, held = run(scene), None, 0
    for _ in range(200):
        stop, seen = threading.Event(), []

        def stop_soon(session, stop=stop, seen=seen):
            seen.append(1)
            if len(seen) == 3:
                stop.set()

        session = run(scene, 2, stop_soon, left and unpack(left), stop)
        if session.finished:
            break
        assert session.drive.done > held
        left, held = session.left, session.drive.done
    assert held > 0 and content(session) == content(whole)


def test_states_come_back_as_they_were():
    tree = {"a": [1, 2.5, None, True, "x"], "b": {"c": np.arange(6.0).reshape(2, 3), "d": []}, "e": np.zeros((0, 3))}
    found = unpack(pack(tree))
    assert found["a"] == tree["a"] and found["b"]["d"] == []
    assert np.array_equal(found["b"]["c"], tree["b"]["c"]) and found["e"].shape == (0, 3)
    assert pack(found) == pack(tree)


@pytest.mark.parametrize("damage", [b"", b"PK", lambda content: content[: len(content) // 2]])
def test_what_is_no_state_is_said_to_be_none(damage):
    content = pack({"a": np.arange(100.0)})
    with pytest.raises(ValueError, match="not the state"):
        unpack(damage(content) if callable(damage) else damage)
