"""Runs that stop at an accuracy: stopping biases nothing, and the true error is as asked for in nine of ten runs.

The target lies where it is hardest, at the error of a first round: half of the seeds stop there, those that believe
they are better. If nine of ten runs meet it, 80 or fewer of 100 do once in 500 times; means over seeds are off by 4
sigma of t once in 8,000 times, for each of some 20 blocks: a right program fails in 5e-3 of the cases.
"""

import threading
from functools import partial

import numpy as np
import pytest

from goniosim import simulate
from goniosim.accuracy import norm
from goniosim.engine import assembly
from goniosim.engine.analog import AnalogRun
from goniosim.engine.drive import Drive, Limit
from goniosim.engine.estimate import valid_size
from goniosim.engine.estimators import ESTIMATORS
from goniosim.engine.layout import DOWN, UP
from goniosim.engine.plan import make_plan
from goniosim.engine.replicated import ReplicatedRun
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

SEEDS = 100
FEWEST_MET = 81
# Cells of a block along rows and columns; dimmer blocks are not normally distributed.
BLOCK = (3, 6)
DIMMEST = 1e-3

METAL = [dielectric(1.5, 0.2), medium([0.05, 0.1, 0.4]), conductor(1.45, [1.0, 0.01, 0.01], 0.2)]
NARROW = [dielectric(1.5, 0.02), medium([0.05, 0.1, 0.4]), conductor(1.45, [1.0, 0.01, 0.01], 0.02)]
PLASTIC = [dielectric(1.5, 0.2), lambert([0.1, 0.6, 0.2])]
SLAB = [dielectric(1.5, 0.3), medium([0.05, 0.1, 0.4]), dielectric(1.0, 0.2)]


class Runs:
    """Runs of one estimator that stop at the accuracy of their first rounds."""

    def __init__(self, plan, start, side):
        self.plan, self.start, self.side = plan, start, side
        self.drive = Drive(1, threading.Event(), lambda done, total: None)

    def energy(self, run):
        return run.estimate(self.side, 0).energy

    def reached(self, key, of, target):
        """A run until its target; of one round if that is infinite."""
        run = self.start(key)
        run.prepare()
        judge = partial(self.judge, of, target)
        self.drive.reach([run], judge, lambda run: None, Limit(None, None), self.drive.do)
        return run

    def judge(self, of, target, run, direction):
        return bool(self.error(run, of) <= target)

    def error(self, run, of):
        return assembly.worst_error(self.plan, run, 0, of)

    def truth(self, rays, seed):
        run = self.start(12345 + seed)
        run.prepare()
        for works in run.rounds(rays):
            self.drive.do(run, works)
        return run.estimate(self.side, 0)

    def check(self, of, rays, seed):
        truth = self.truth(rays, seed)
        target = np.mean([self.error(self.reached(seed + 1000 + n, of, np.inf), of) for n in range(8)])
        runs = [self.reached(seed + n, of, target) for n in range(SEEDS)]
        assert len({run.rays[0] for run in runs}) > 1
        found = np.stack([self.energy(run) for run in runs])
        errors = np.array([self.true_error(energy, truth.energy, of) for energy in found])
        self.no_bias(found, truth)
        assert np.sum(errors <= target) >= FEWEST_MET

    def true_error(self, energy, truth, of):
        if of == "albedo":
            sums = truth.sum(axis=(1, 2))
            return np.mean(np.abs(energy.sum(axis=(1, 2)) - sums) / sums)
        size = valid_size(self.plan, 0)
        return np.mean(norm(energy - truth, size) / norm(truth, size))

    def no_bias(self, found, truth):
        totals = self.z(found.sum(axis=(1, 2, 3)), truth.energy.sum(), truth.total_stderr.sum())
        assert abs(totals) < 4.0
        blocks, expected, variance = (_blocks(each) for each in (found, truth.energy, truth.stderr**2))
        bright = expected > DIMMEST * expected.sum()
        # Both halves hold the same.
        z = self.z(blocks, expected, np.sqrt(2.0 * variance))[bright]
        assert z.size >= 8 and np.abs(z).max() < 4.0

    def z(self, found, expected, stderr):
        sigma = np.sqrt(found.var(axis=0, ddof=1) / len(found) + stderr**2)
        return (found.mean(axis=0) - expected) / np.maximum(sigma, 1e-300)


def _blocks(values):
    """Sums over the channels and over the cells of blocks."""
    values = values.sum(axis=-3)
    rows, columns = values.shape[-2] // BLOCK[0], values.shape[-1] // BLOCK[1]
    return values.reshape(*values.shape[:-2], rows, BLOCK[0], columns, BLOCK[1]).sum(axis=(-3, -1))


def plan_of(layers):
    return make_plan(make_scene(layers, 40.0, rows=18, columns=36))


stops = pytest.mark.false_alarm(5e-3, seeds=(0, 100_000, 200_000, 300_000))


@stops
@pytest.mark.parametrize("of", ["slice", pytest.param("albedo", marks=pytest.mark.slow)])
def test_independent_paths(of, monkeypatch, seed):
    monkeypatch.setattr("goniosim.engine.analog.FIRST_ROUND", 1 << 14)
    plan = plan_of(METAL)
    Runs(plan, lambda key: AnalogRun(plan, key, (UP,)), UP).check(of, 1 << 22, seed)


@pytest.mark.slow
@stops
@pytest.mark.parametrize("of", ["slice", "albedo"])
@pytest.mark.parametrize(
    ("layers", "name", "side"),
    [(PLASTIC, "connection", UP), (METAL, "operator", UP), (SLAB, "operator", DOWN), (NARROW, "split", UP)],
    ids=["connection", "operator", "operator, slab", "split"],
)
def test_replicates(layers, name, side, of, seed):
    plan = plan_of(layers)
    # What it prepares is made once.
    estimator = ESTIMATORS[name](plan, (side,))
    Runs(plan, lambda key: ReplicatedRun(plan, estimator, (side,), key), side).check(of, 1 << 23, seed)


@pytest.mark.slow
def test_where_nodes_leave_no_room_in_the_target_the_next_best_takes_over():
    layers = [dielectric(1.5, 0.05), conductor(1.9, [1.0, 0.5, 0.2], 0.001)]
    scene = make_scene(layers, 0.0, parametrization="half", rows=45, columns=180)
    named = simulate(scene, target=0.008, estimator="operator")
    assert named.target_reached is False
    found = simulate(scene, target=0.008)
    component = found.components["reflection/internal"]
    assert found.target_reached is True and component.estimator == ["split"] and component.node_bias is None
    assert "split (operator: its nodes may be off by" in found.provenance["estimator_choice"]
    # What the first try took counts, in time.
    alone = simulate(scene, target=0.008, estimator="split", seed=2)
    assert found.cost.cpu_seconds[0, -1] > alone.cost.cpu_seconds[0, -1]
    again = simulate(scene, target=0.008, threads=1)
    assert np.array_equal(again.components["reflection/internal"].energy, component.energy)
