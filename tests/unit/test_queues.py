"""Queues never hold more than they have room for, and the room grows little faster than the stack."""

import numpy as np
import pytest

from goniosim.engine.layout import N_LEDGER
from goniosim.engine.plan import make_plan
from goniosim.engine.tally import record_length
from goniosim.engine.unit import BATCH, Workspace, queue_capacity, unit_key
from reference.scenes import dielectric, lambert, make_scene


def _adversary(n):
    """Fill of the fullest queue against the one who adds where it hurts most, in batches."""
    fill = np.ones(n)
    worst = 0.0
    alive = list(range(n))
    while alive:
        served = int(np.argmax(fill))
        fill[served] -= min(1.0, fill[served])
        alive = [q for q in alive if q != served]
        # What was served goes in equal shares to those that were not served yet.
        fill[alive] += 1.0 / max(len(alive), 1)
        worst = max(worst, fill.max())
    return worst


@pytest.mark.parametrize("n", [2, 3, 8, 100])
def test_the_room_is_enough_and_hardly_more_than_that(n):
    worst = _adversary(n) * BATCH
    assert queue_capacity(n) - 1.5 * BATCH < worst <= queue_capacity(n)


def test_no_random_traffic_overflows():
    rng = np.random.default_rng(1)
    n, worst = 12, 0.0
    fill = np.zeros(n)
    for _ in range(5000):
        if fill.max() < 1.0:
            added = 1.0
        else:
            served = np.argmax(fill)
            added = min(1.0, fill[served])
            fill[served] -= added
        # As in a stack: to two queues.
        share = rng.random()
        fill[rng.integers(n)] += share * added
        fill[np.argsort(fill)[-rng.integers(1, n)]] += (1.0 - share) * added
        worst = max(worst, fill.max())
    assert 1.0 < worst * BATCH <= queue_capacity(n)


@pytest.mark.parametrize("alpha", [0.0, 0.4])
def test_the_queues_of_a_deep_stack_keep_within_their_room(alpha):
    layers = [dielectric(1.5 if i % 2 else 1.1, alpha) for i in range(8)] + [lambert(0.9)]
    plan = make_plan(make_scene(layers, 30.0, rows=1, columns=1))
    workspace = Workspace(plan)
    cells = workspace.cells(0, 1, 1, np.zeros((plan.n_slots, record_length(plan.n_distinct))))
    ledger = np.zeros((N_LEDGER, plan.n_distinct))
    workspace.begin(12_000)
    most, finished = 0, False
    while not finished:
        finished = workspace.advance(0, unit_key(1, 0, 0), 1, ledger, cells)
        most = max(most, workspace.filled.max())
    assert BATCH < most <= workspace.queues.shape[2] == queue_capacity(18)


def test_room_grows_little_faster_than_the_number_of_interfaces():
    per_interface = [queue_capacity(2 * k) / BATCH for k in (3, 300, 1000)]
    assert per_interface[2] < 10.0 and per_interface[1] < 3.0 * per_interface[0]
