"""Replicates against independent paths: the same means, errors that are right, the same bits on any threads."""

import functools
import threading

import numpy as np
import pytest

from goniosim import simulate
from goniosim.effective import effective_count
from goniosim.engine import assembly
from goniosim.engine.analog import AnalogRun
from goniosim.engine.drive import Drive
from goniosim.engine.estimate import noise
from goniosim.engine.estimators import Operator, Split
from goniosim.engine.gain import gains, noise_of_a_path
from goniosim.engine.layout import DOWN, UP
from goniosim.engine.plan import make_plan
from goniosim.engine.replicated import ReplicatedRun
from goniosim.engine.rounds import REPLICATES as N_REPLICATES
from plain import Plain
from reference.scenes import dielectric, make_scene, medium

SLAB = [dielectric(1.5, 0.3), medium([0.05, 0.1, 0.4]), dielectric(1.0, 0.2)]
RAYS = 400_000
# Cells with fewer effective replicates are not normally distributed.
ENOUGH = 12


def shot(run, threads=2, rays=RAYS, stop=None):
    """The run, done."""
    run.prepare()
    drive = Drive(threads, stop or threading.Event(), lambda done, total: None)

    def note(run, m):
        run.spending.note(m, run.rays[m], drive.now(), assembly.errors(run._plan, run, m))

    for works in run.rounds(rays):
        drive.do(run, works, note)
    return run


def plan_of(columns, orders=None):
    asked = {"orders": orders} if orders else {}
    return make_plan(make_scene(SLAB, [0.0, 60.0], rows=9, columns=columns, **asked))


# An odd number of columns has no halves.
PAIRS = {"folded": (36, None), "odd, orders": (37, 2)}


@functools.cache
def pair_of(name, seed=1):
    """The same slab by independent paths and by replicates."""
    plan = plan_of(*PAIRS[name])
    return plan, shot(AnalogRun(plan, seed, (UP, DOWN))), shot(ReplicatedRun(plan, Plain(plan), (UP, DOWN), seed))


@pytest.fixture(params=PAIRS)
def pair(request):
    return pair_of(request.param)


def views(plan):
    orders = {UP: 2, DOWN: 3} if plan.orders else {UP: 0, DOWN: 0}
    return [(side, order) for side in (UP, DOWN) for order in (None, *range(orders[side]))]


@pytest.mark.false_alarm(1.3e-3, seeds=(1, 101, 201))
@pytest.mark.parametrize("name", PAIRS)
def test_means_and_errors_agree(name, seed):
    """Of up to 14 views the rms of deviations to 4 sigma, and three totals to 4.5: a false alarm in 1.3e-3."""
    plan, analog, run = pair_of(name, seed)
    for side, order in views(plan):
        for m in range(2):
            one, other = analog.estimate(side, m, order), run.estimate(side, m, order)
            assert other.hits is None and one.batches is None
            a, sigma_a, b, sigma_b = one.energy, one.stderr, other.energy, other.stderr
            number = effective_count(b, sigma_b, other.count)
            z = ((a - b) / np.sqrt(sigma_a**2 + sigma_b**2 + 1e-300))[number > ENOUGH]
            # Three channels and two halves share paths. Four sigmas: one false alarm in 16,000.
            assert np.sqrt((z**2).mean()) == pytest.approx(1.0, abs=4.0 / np.sqrt(2.0 * z.size / 6.0))
            # Both halves tell of a cell.
            assert (sigma_b**2).sum() == pytest.approx(0.5 * (sigma_a**2).sum(), rel=0.5)
            off = np.abs((a - b).sum(axis=(1, 2)))
            assert (off < 4.5 * np.hypot(one.total_stderr, other.total_stderr)).all()


def test_orders_add_up(pair):
    plan, _, run = pair
    if plan.orders:
        for side, count in ((UP, 2), (DOWN, 3)):
            parts = sum(run.estimate(side, 1, order).energy for order in range(count))
            assert np.allclose(parts, run.estimate(side, 1).energy, rtol=1e-12, atol=0.0)


def test_checkpoints_fall_on_rounds_and_errors_shrink(pair):
    plan, analog, run = pair
    cost = assembly.cost(plan, [run])
    assert cost.rays.shape == (2, 2) and cost.rays[0].tolist() == [run.rays[0] / 3, run.rays[0]]
    assert cost.seconds[:, -1].sum() > 0.0 and (np.diff(cost.cpu_seconds) > 0.0).all()
    assert all((np.diff(error) < 0.0).all() for error in cost.error.values())
    assert set(cost.error) == {"reflection/internal", "transmission"}
    assert (run.spending.events > run.rays).all() and analog.finished and run.finished


@pytest.mark.parametrize(
    "run_of", [lambda plan: AnalogRun(plan, 7, (UP, DOWN)), lambda p: ReplicatedRun(p, Plain(p), (UP, DOWN), 7)]
)
def test_the_same_bits_on_any_number_of_threads(run_of):
    plan = plan_of(36)
    one, *others = (shot(run_of(plan), threads, rays=50_000) for threads in (1, 2, 3))
    for other in others:
        for side in (UP, DOWN):
            for m in range(2):
                a, b = (run.estimate(side, m) for run in (one, other))
                assert np.array_equal(a.energy, b.energy) and np.array_equal(a.stderr, b.stderr)
                assert np.array_equal(a.total_stderr, b.total_stderr)


def test_components_that_run_apart_are_the_same():
    plan = plan_of(36)
    both = shot(ReplicatedRun(plan, Plain(plan), (UP, DOWN), 7), rays=50_000)
    for side in (UP, DOWN):
        alone = shot(ReplicatedRun(plan, Plain(plan, (side,)), (side,), 7), rays=50_000)
        assert alone.sides == (side,) and np.array_equal(alone.estimate(side, 1).energy, both.estimate(side, 1).energy)


class Stopping(Plain):
    """Sets the stop after so many calls."""

    def __init__(self, plan, stop, calls):
        super().__init__(plan)
        self.stop, self.calls = stop, calls

    def workspace(self):
        space = super().workspace()
        run = space.run

        def counted(*arguments):
            self.calls -= 1
            if self.calls == 0:
                self.stop.set()
            return run(*arguments)

        space.run = counted
        return space


def test_a_stop_keeps_whole_replicates():
    plan, stop = plan_of(36), threading.Event()
    run = shot(ReplicatedRun(plan, Stopping(plan, stop, 9), (UP, DOWN), 1), threads=1, rays=50_000, stop=stop)
    size = 50_016 // 32
    assert not run.finished and 8 * size <= run.rays[0] < 50_000 and run.rays[0] % size == 0
    assert len(run.spending.checkpoints[0]) == 1 and run.estimate(DOWN, 0).energy.sum() > 0.3


@pytest.mark.false_alarm(1e-12)
def test_a_few_paths_without_slices_tell_the_noise_of_independent_paths(pair):
    """To 10 %: over many seeds they are 5 % high at the most, and scatter by 0.5 %."""
    plan, analog, run = pair
    short = shot(AnalogRun(plan.in_one_cell(), 3), rays=50_000)
    for side in (UP, DOWN):
        for m in range(2):
            energy = run.estimate(side, m).energy
            told = noise_of_a_path(plan, m, energy, short.estimate(side, m)) / np.sqrt(analog.rays[m])
            assert told == pytest.approx(noise(plan, m, analog.estimate(side, m).stderr), rel=0.1)
    # Replicates of independent paths gain a factor of two where they are folded; a busy machine blurs it.
    found = gains(plan, [run], short)
    assert set(found) == {"reflection/internal", "transmission"} and all(0.1 < gain < 10.0 for gain in found.values())
    assert gains(plan, [analog], short) == {}


def test_both_components_of_a_slab_grow_until_the_limit():
    """What nodes may be off by leaves no room for the reflection, which goes on with smaller replicates."""
    scene = make_scene([dielectric(1.5, 0.3), dielectric(1.0, 0.3)], 30.0, rows=9, columns=36)
    found = simulate(scene, target=1e-4, max_rays=8e5)
    estimators = {"reflection/internal": Split, "transmission": Operator}
    rays = [3 * N_REPLICATES * each.smallest for each in estimators.values()]
    assert found.target_reached is False and found.rays.tolist() == [min(rays)]
    assert found.cost.rays[0, -1] == max(rays) > min(rays)
    for name, each in estimators.items():
        assert found.components[name].estimator == [each.name]
        assert (np.diff(found.cost.error[name]) < 0.0).all()
