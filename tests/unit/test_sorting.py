"""Sorting a batch into reflected rays and those that went through: both ways of it do the same."""

import numpy as np
import pytest

from goniosim._jit import kernel
from goniosim.engine.sorting import LANES, by_lanes, by_places

BATCH = 64
list_places, move_places = by_places
mark_lanes, move_lanes = by_lanes


@kernel
def _by_places(gain, transmitted, n, source, steps, places, rows, start):
    counts = list_places(gain, transmitted, n, steps, places[0], places[1])
    for way in range(2):
        move_places(source, n, places[way], counts[way], rows[way], start)
    return counts


@kernel
def _by_lanes(gain, transmitted, n, source, steps, places, rows, start):
    counts = mark_lanes(gain, transmitted, n, steps, places[0], places[1])
    for way in range(2):
        move_lanes(source, n, places[way], counts[way], rows[way], start)
    return counts


@pytest.mark.parametrize("sort_and_move", [_by_places, _by_lanes])
@pytest.mark.parametrize("n", [1, 7, 8, 9, 40, 63, 64])
@pytest.mark.parametrize("alive, through", [(1.0, 0.5), (0.5, 0.5), (1.0, 1.0), (1.0, 0.0), (0.0, 0.5)])
def test_every_ray_goes_where_it_belongs_in_its_order(sort_and_move, n, alive, through):
    rng = np.random.default_rng(n)
    gain = np.where(rng.random(BATCH) < alive, 0.7, 0.0)
    transmitted = np.where(rng.random(BATCH) < through, 1.0, 0.0)
    source = np.arange(BATCH) + 1.0
    start, room = 3, 3 + BATCH + LANES
    rows = np.zeros((2, room + 1))
    steps, places = np.empty(BATCH, np.uint64), np.empty((2, BATCH), np.uint32)
    counts = sort_and_move(gain, transmitted, n, source, steps, places, rows, start)
    for way, chosen in enumerate([transmitted == 0.0, transmitted > 0.0]):
        expected = source[:n][(gain[:n] > 0.0) & chosen[:n]]
        assert counts[way] == len(expected)
        assert (rows[way, start : start + len(expected)] == expected).all()
        assert not rows[way, :start].any() and not rows[way, start + len(expected) + LANES :].any()
