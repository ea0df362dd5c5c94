"""Random numbers in the orders in which walks use them: over rays, stages, units, directions, seeds, replicates.

A hash of a key and a counter may be fair along the counter, and still show a pattern along keys.
"""

import numpy as np
import pytest

from goniosim.engine.stages.facets import FACET_AZIMUTH, FACET_HEIGHT
from goniosim.engine.unit import BATCH
from reference.randomness import boxes, chances, correlations, smallest
from reference.streams import (
    FAR_SEEDS,
    STREAMS,
    analog_keys,
    children,
    numbers,
    replicate_keys,
    stream,
    turns,
)

FEW, MANY = 1 << 16, 1 << 21


def _check(name, n):
    found = chances(stream(name, n))
    assert smallest(found) > 1e-9, found


@pytest.mark.false_alarm(1e-9)
@pytest.mark.parametrize("name", STREAMS)
def test_each_order_is_uniform_and_without_memory(name):
    """Boxes in 1, 2 and 3 dimensions, serial correlation, spectrum, bits; false alarm 1e-9 for each order."""
    _check(name, FEW)


@pytest.mark.slow
@pytest.mark.false_alarm(1e-9)
@pytest.mark.parametrize("name", STREAMS)
def test_each_order_is_so_at_length(name):
    """Two million numbers; false alarm 1e-9 for each order."""
    _check(name, MANY)


RELATIVES = {
    "units": lambda n: analog_keys(units=range(n)),
    "directions": lambda n: analog_keys(directions=range(n)),
    "seeds": lambda n: analog_keys(seeds=range(n)),
    "far seeds": lambda n: analog_keys(seeds=[far + i for far in FAR_SEEDS for i in range(n // len(FAR_SEEDS))]),
    "stages": lambda n: analog_keys(stages=range(n)),
    "decisions": lambda n: analog_keys(stages=range(n // 4), decisions=range(4)),
    "replicates": lambda n: replicate_keys(replicates=range(n)),
    "rounds": lambda n: replicate_keys(rounds=range(n)),
    "parents and children": lambda n: np.stack(
        [key := replicate_keys(replicates=range(n // 2)), children(key, [6])[..., 0]]
    ),
}


def _with_children(keys):
    return np.stack([keys, children(keys, [6])[..., 0]])


def _check_relatives(name, count, n):
    keys = RELATIVES[name](count).ravel()
    assert correlations(numbers(keys, n)) > 1e-9


@pytest.mark.false_alarm(1e-9)
@pytest.mark.parametrize("name", RELATIVES)
def test_relatives_are_uncorrelated(name):
    """The same counters of 120 keys, all pairs; false alarm 1e-9 for each kind of relatives."""
    _check_relatives(name, 120, 2048)


@pytest.mark.slow
@pytest.mark.false_alarm(1e-9)
@pytest.mark.parametrize("name", RELATIVES)
def test_many_relatives_are_uncorrelated(name):
    """1200 keys, 720,000 pairs; false alarm 1e-9 for each kind of relatives."""
    _check_relatives(name, 1200, 1 << 15)


def _check_azimuths(n):
    """Azimuths with what the same stage draws besides: three numbers each, as points of a cube."""
    stage = analog_keys(stages=range(n // BATCH), decisions=(FACET_AZIMUTH, FACET_HEIGHT))[0, 0, 0, 0]
    found = {}
    azimuths, heights = turns(stage[:, 0], BATCH), numbers(stage[:, 1], BATCH)
    # The next ray of the stage, and the same ray at the next stage.
    found["ray"] = boxes(_points(azimuths[:, :-1], heights[:, :-1], azimuths[:, 1:]))
    found["stage"] = boxes(_points(azimuths[:-1], heights[:-1], azimuths[1:]))
    # The ray of an operator draws from one key: counter 0 is the azimuth, and its bits make the key of the next event.
    key = children(replicate_keys(), [1], range(n)).ravel()
    azimuth = turns(key, 1)[:, 0]
    for counter in (1, 2, 3, 4, 5):
        rest = numbers(key, [counter, counter % 5 + 1])
        found[f"counter {counter}"] = boxes(_points(azimuth, rest[:, 0], rest[:, 1]))
    for branch in (6, 7):
        later = children(key, [branch]).ravel()
        for counter in range(1, 6):
            found[f"branch {branch}, {counter}"] = boxes(_points(azimuth, turns(later, 1), numbers(later, [counter])))
    # Two bits choose the axis, the others the angle about it.
    found["alone"] = boxes(_points(azimuth))
    assert smallest(found) > 1e-9, found


def _points(*columns):
    return np.stack([np.ravel(column) for column in columns], axis=1)


@pytest.mark.false_alarm(1e-9)
def test_azimuths_go_with_nothing_that_is_drawn_beside_them():
    """Chi-square of triples; false alarm 1e-9."""
    _check_azimuths(1 << 16)


@pytest.mark.slow
@pytest.mark.false_alarm(1e-9)
def test_many_azimuths_go_with_nothing_that_is_drawn_beside_them():
    """As above, of two million azimuths."""
    _check_azimuths(1 << 21)
