"""No two decisions share a random number: of all draws of small walks, and of many keys."""

import json
import os
import re
import subprocess
import sys
from collections import Counter, defaultdict
from pathlib import Path

import numpy as np
import pytest

import goniosim
from goniosim.engine.stages.smooth_dielectric import COIN
from goniosim.engine.unit import BATCH, PARTS, unit_key
from reference import splitmix
from reference.randomness import crowding
from reference.streams import FAR_SEEDS, analog_keys, children, numbers, replicate_keys

TESTS = Path(__file__).resolve().parents[1]
# The shifts of a lattice, which each batch of paths looks up again.
LOOKED_UP_AGAIN = {f"engine/operators/facets.py:{name}" for name in ("azimuth", "height", "mixture")}


@pytest.fixture(scope="module")
def drawn():
    """By walk: for each draw its key, its counter, and the file and line that asked for it."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), str(TESTS.parent)])}
    done = subprocess.run(
        [sys.executable, "-m", "reference.drawn"], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def _lines_that_draw():
    """File and line of every draw in the engine, with the text."""
    folder = Path(goniosim.__file__).parent
    return {
        f"{path.relative_to(folder)}:{number}": line.strip()
        for path in sorted((folder / "engine").rglob("*.py"))
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if re.search(r"\b(uniform|random_sincos)\(", line)
    }


def test_every_line_that_draws_is_walked(drawn):
    """What follows speaks of all of them."""
    assert {place for walk in drawn.values() for *_, place in walk} == set(_lines_that_draw())


def test_no_number_is_drawn_twice(drawn):
    """Not by another key and counter either: all draws are places on one cycle."""
    lines = _lines_that_draw()
    for name, walk in drawn.items():
        asked = defaultdict(Counter)
        for key, counter, place in walk:
            asked[key + counter * splitmix.GOLDEN & 2**64 - 1][place] += 1
        for places in asked.values():
            assert len(places) == 1, f"{name}: {places}"
            ((place, times),) = places.items()
            again = place.rpartition(":")[0] + ":" + lines[place].partition(" ")[0]
            assert times == 1 or again in LOOKED_UP_AGAIN, f"{name}: {place}, {times} times"


def test_analog_draws_are_those_of_the_streams(drawn):
    """The sequences that other tests look at are those of the walk."""
    used = {key for key, *_ in drawn["analog"]}
    known = children([0x123456789ABCDEF], range(PARTS), range(200), range(4))
    assert used <= set(known.ravel().tolist())
    assert len(used) > 50
    assert max(counter for _, counter, _ in drawn["analog"]) < BATCH


def test_operator_draws_are_those_of_the_streams(drawn):
    """As above: keys of paths, and of their branches."""
    draws = [(key, counter) for key, counter, place in drawn["many paths"] if "gather" not in place]
    assert {counter for _, counter in draws} == set(range(6))
    used = {key for key, _ in draws} - set(children([0x123456789ABCDEF], [0]).tolist()[0])
    event = used.intersection(children([0x123456789ABCDEF], [1], range(600)).ravel().tolist())
    assert len(event) > 300
    while event:
        used -= event
        event = used.intersection(children(sorted(event), (6, 7)).ravel().tolist())
    assert not used


def test_draws_of_arrays_are_those_of_the_code():
    """Forwards and backwards."""
    for key in (0, 1, 2**63, 2**64 - 1, 0x123456789ABCDEF):
        for number in (0, 1, 5, 2**31):
            child = int(children([key], [number])[0, 0])
            assert splitmix.child(key, number) == child and splitmix.parent(child, number) == key
            bits = splitmix.mix(key + number * splitmix.GOLDEN & 2**64 - 1)
            assert numbers([key], [number])[0, 0] == (bits >> 12) * 2.0**-52
            assert splitmix.key_that_draws(bits, number) == key
    units = analog_keys(seeds=(7,), directions=(3,), units=(5,), parts=(2,), stages=(9,), decisions=(COIN,))
    assert units.item() == children([int(unit_key(7, 3, 5))], [2], [9], [COIN]).item()


KEYS = {
    "stages and decisions": lambda n: analog_keys(stages=range(n // 4), decisions=range(4)),
    "parts and units": lambda n: analog_keys(units=range(n // PARTS), parts=range(PARTS)),
    "directions and units": lambda n: analog_keys(directions=range(100), units=range(n // 100)),
    "seeds": lambda n: analog_keys(seeds=range(n)),
    "far seeds": lambda n: analog_keys(seeds=[far + i for far in FAR_SEEDS for i in range(n // len(FAR_SEEDS))]),
    "replicates": lambda n: replicate_keys(directions=range(100), rounds=range(n // 6400), replicates=range(64)),
    "paths": lambda n: children(replicate_keys(), [1], range(n)),
    "paths and branches": lambda n: np.concatenate(
        [(paths := children(replicate_keys(), [1], range(n // 3))).ravel(), children(paths, (6, 7)).ravel()]
    ),
    "cells": lambda n: children(replicate_keys(), [1], range(n)),
}


def _check_keys(name, n):
    keys = np.unique(KEYS[name](n).ravel())
    assert len(keys) == KEYS[name](n).size
    assert crowding(splitmix.places(keys)) > 1e-9


@pytest.mark.false_alarm(1e-9)
@pytest.mark.parametrize("name", KEYS)
def test_keys_are_far_from_each_other(name):
    """Draws of two keys are the same where the keys are neighbours on the cycle of all draws, so many steps apart.

    Of 10^5 random keys, some 500 stand within 2^40 steps of another. More at any distance would be a pattern, and
    two within thousands of steps would share draws; false alarm 1e-9.
    """
    _check_keys(name, 100_000)


@pytest.mark.slow
@pytest.mark.false_alarm(1e-9)
@pytest.mark.parametrize("name", KEYS)
def test_many_keys_are_far_from_each_other(name):
    """As above, of three million."""
    _check_keys(name, 3_000_000)
