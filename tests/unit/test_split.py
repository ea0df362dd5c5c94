"""What an estimator owes its driver, kept by the split walk; and how it spends its facets and queues."""

import math
import threading
from dataclasses import replace

import numpy as np
import pytest

from goniosim.engine import simulate
from goniosim.engine.estimators.split import Split
from goniosim.engine.lattice import DIMENSIONS
from goniosim.engine.layout import DOWN, UP, WEIGHT, X, Y, Z
from goniosim.engine.splitting.deposit import share_out
from goniosim.engine.splitting.dielectric import go_through, meet_dielectric
from goniosim.engine.splitting.effort import CROWD, Effort
from goniosim.engine.splitting.exits import let_through
from goniosim.engine.splitting.layout import (
    AMOUNT,
    EXIT,
    FACET_RATIO,
    FACET_X,
    FACET_Y,
    FACET_Z,
    HASHED,
    LEFT,
    N_SCRATCH,
    POINT_U,
    POINT_V,
    RATIO,
    THROUGH_X,
)
from goniosim.engine.splitting.lobes import MOST_FACETS, facets_per_arrival
from goniosim.engine.splitting.numbers import MOST, facet_numbers, far_facet, lattice_shifts
from goniosim.engine.stages import ROUGH_DIELECTRIC
from goniosim.engine.unit import BATCH
from reference.replicates import keys, make_replicates, prepared, totals
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

PLASTIC = [dielectric(1.5, 0.05), medium([0.05, 0.1, 0.4]), lambert([0.1, 0.6, 0.2])]
METAL = [dielectric(1.5, 0.2), medium(0.1), conductor(1.45, [1.0, 0.01, 0.01], 0.2)]
SLAB = [dielectric(1.5, 0.1), medium([0.05, 0.1, 0.4]), dielectric(1.0, 0.2)]
THREE = [dielectric(1.3, 0.1), medium(0.1), dielectric(1.6, 0.2), medium(0.2), dielectric(1.2, 0.3)]


def small(layers, theta=40.0, parametrization="classic", rows=6, columns=12, **simulation):
    return make_scene(layers, theta, parametrization, rows, columns, **simulation)


@pytest.mark.parametrize("layers", [PLASTIC, SLAB, THREE], ids=["plastic", "slab", "three"])
def test_a_replicate_depends_on_its_key_alone_and_overwrites_everything(layers):
    plan, split = prepared(Split, small(layers))
    used, fresh = split.workspace(), split.workspace()
    found = []
    for workspace, key in ((used, 1), (used, 0), (fresh, 0)):
        out = np.full((1, plan.n_slots, plan.n_distinct, plan.rows, plan.width), np.nan)
        events = workspace.run(0, 700, keys(3, 2)[key : key + 1], out, threading.Event())
        assert events > 700
        assert np.isfinite(out).all() and out.min() >= 0.0
        found.append(out)
    assert (found[0] != found[1]).any()
    np.testing.assert_array_equal(found[1], found[2])
    again = prepared(Split, small(layers))[1]
    np.testing.assert_array_equal(again.scales, split.scales)


def test_a_stop_is_heard():
    plan, split = prepared(Split, small(METAL))
    stop = threading.Event()
    stop.set()
    out = np.empty((1, 1, plan.n_distinct, plan.rows, plan.width))
    assert split.workspace().run(0, 1 << 22, keys(1, 1), out, stop) is None


@pytest.mark.parametrize("layers", [METAL, SLAB, THREE], ids=["metal", "slab", "three"])
def test_orders_add_up_to_the_whole(layers):
    """The random numbers are the same: up to rounding."""
    plan, split = prepared(Split, small(layers))
    whole = make_replicates(plan, split, 600, seed=1, count=2)
    plan, split = prepared(Split, small(layers, orders=2))
    orders = make_replicates(plan, split, 600, seed=1, count=2)
    first = 0
    for number, side in enumerate(side for side in (UP, DOWN) if plan.slots[side, 1]):
        count = plan.slots[side, 1]
        assert orders[:, first : first + count].any(axis=(0, 2, 3, 4)).all()
        total = orders[:, first : first + count].sum(axis=1)
        np.testing.assert_allclose(total, whole[:, number], rtol=1e-12, atol=1e-18)
        first += count


def test_ways_out_can_be_asked_for_one_by_one():
    """Paths are the same where both ways deserve as many facets: up to rounding."""
    both = make_replicates(*prepared(Split, small(SLAB)), 600, seed=1, count=1)
    for number, side in enumerate((UP, DOWN)):
        plan, split = prepared(Split, small(SLAB), (side,))
        split.facets[:, side] = prepared(Split, small(SLAB))[1].facets[:, side]
        alone = make_replicates(plan, split, 600, seed=1, count=1)
        assert alone.shape[1] == 1
        assert alone.sum() == pytest.approx(both[:, number].sum(), rel=0.1)


@pytest.mark.parametrize("layers", [METAL, PLASTIC], ids=["metal", "plastic"])
def test_columns_do_not_matter_to_rows(layers):
    """Odd numbers of columns are not folded. Paths are the same: up to rounding."""
    sums = []
    for columns in (12, 13, 1):
        plan, split = prepared(Split, small(layers, columns=columns))
        split.facets[:, UP] = 3
        out = make_replicates(plan, split, 600, seed=1, count=1)[0, 0]
        sums.append(out.sum(axis=-1) * (plan.columns / plan.width))
    np.testing.assert_allclose(sums[1], sums[0], rtol=1e-12)
    np.testing.assert_allclose(sums[2], sums[0], rtol=1e-12)


def test_light_that_has_forgotten_its_azimuth_is_alike_along_rows():
    out = make_replicates(*prepared(Split, small(PLASTIC)), 600, seed=1, count=1)
    assert (out == out[..., :1]).all()


def test_light_in_the_plane_of_incidence_stays_on_the_slice():
    """Its azimuth is 180 degrees, the lower edge of the column in which all of it is."""
    plan, split = prepared(Split, small([dielectric(1.5), medium(0.1), dielectric(1.0)]))
    out = make_replicates(plan, split, 512, seed=1, count=1)[0]
    row = math.floor(40.0 / 15.0)
    for slices in out:
        assert slices[0, row, plan.columns // 2] == slices.sum() > 0.01


def test_memory_is_told_from_shapes():
    _, split = prepared(Split, small(THREE))
    workspace = split.workspace()
    arrays = [
        array for array in vars(workspace).values() if isinstance(array, np.ndarray) and array is not split.scales
    ]
    shared, own = split.memory
    assert shared == 0
    assert own <= sum(array.nbytes for array in arrays) < 1.05 * own


@pytest.mark.parametrize(
    "parametrization, alpha, least, most",
    [
        ("classic", 0.0, 1, 1),
        ("classic", 0.001, 1, 1),
        ("classic", 0.05, 2, MOST_FACETS),
        ("half", 0.001, 2, MOST_FACETS),
    ],
)
def test_wide_exits_get_many_facets(parametrization, alpha, least, most):
    plan, _ = prepared(Split, make_scene([dielectric(1.5, alpha), conductor(1.45, 1.0, 0.2)], 30.0, parametrization))
    assert least <= facets_per_arrival(plan, 0, UP) <= most


def test_the_narrow_way_out_is_not_left_with_few_paths():
    plan, both = prepared(Split, make_scene([dielectric(1.5, 0.001), dielectric(1.0, 0.2)], 30.0))
    assert facets_per_arrival(plan, 0, DOWN) == MOST_FACETS
    assert 1 < both.facets[0, DOWN] < MOST_FACETS
    assert Split(plan, (DOWN,)).facets.tolist() == [[0, MOST_FACETS]]


@pytest.mark.false_alarm(1.2e-4, seeds=(1, 101, 201))
def test_crowds_follow_one_branch_and_agree_with_those_who_follow_both(seed):
    """Totals over seven interfaces within 4.5 sigma of t, 62 and 31 degrees of freedom: a false alarm in 1.2e-4."""
    layers = [dielectric(1.5 if i % 2 else 1.1, 0.4 * (i % 3)) for i in range(6)] + [lambert(0.9)]
    plan, split = prepared(Split, small(layers))
    sums = []
    for crowd in (CROWD * BATCH, -1):
        split.effort = replace(Effort.unbounded(1), crowds=np.array([crowd]))
        sums.append(totals(plan, make_replicates(plan, split, 2048, seed))[:, 0])
    difference = sums[0].mean() - sums[1].mean()
    assert abs(difference) < 4.5 * np.sqrt((sums[0].var(ddof=1) + sums[1].var(ddof=1)) / 32)
    analog = simulate(small(layers), rays=400_000, seed=seed, estimator="analog").audit
    stderr = np.hypot(analog.stderr["reflected_internal"][0, 0], sums[1].std(ddof=1) / 32**0.5)
    assert abs(sums[1].mean() - analog.energy["reflected_internal"][0, 0]) < 4.5 * stderr


def test_no_branching_overflows_a_queue():
    layers = [dielectric(4.0 if i % 2 else 1.1, 0.4) for i in range(7)] + [dielectric(1.0, 0.4)]
    plan, split = prepared(Split, small(layers))
    # Without roulette, branches multiply.
    split.scales[:] = 1e300
    workspace = split.workspace()
    workspace.begin(4 * BATCH)
    most = 0
    for _ in range(4000):
        workspace.advance(0, keys(1, 1)[0], 1, CROWD * BATCH)
        most = max(most, workspace.filled.max())
    assert workspace.state[LEFT] < 4 * BATCH
    assert CROWD * BATCH < most <= workspace.queues.shape[2]


def test_facets_drawn_for_the_tails_are_weighed_by_what_they_are_worth():
    """Means over a regular grid of numbers: those of plain numbers, whether of the body or of the far tail."""
    drawn = np.array([far_facet(u) for u in (np.arange(20_000) + 0.5) / 20_000]).T
    height, ratio = drawn
    assert (np.diff(height) > 0.0).all() and ratio.min() > 0.0
    assert ratio.mean() == pytest.approx(1.0, rel=1e-6)
    assert (ratio * height**2).mean() == pytest.approx(1.0 / 3.0, rel=1e-6)
    assert (ratio * (1.0 - height) ** -0.2).mean() == pytest.approx(1.25, rel=1e-3)
    for beyond in (1e-3, 1e-5):
        assert (ratio * (height > 1.0 - beyond)).mean() == pytest.approx(beyond, rel=0.05)
        # Plain numbers would be as many as the width of the tail.
        assert (height > 1.0 - beyond).mean() > 10.0 * beyond


@pytest.mark.false_alarm(7e-6, seeds=(2, 102))
def test_weights_of_long_paths_are_bounded(seed):
    """After 400 facets, as where light is caught, ratios still have mean 1: within 4.5 sigma, false alarm 7e-6."""
    n, rng = 4000, np.random.default_rng(seed)
    before, (cosines, sines, heights, ratios) = np.ones(n), np.empty((4, n))
    for _ in range(400):
        facet_numbers(*rng.random((2, n)), n, 0, HASHED, before, cosines, sines, heights, ratios)
        before *= ratios
    assert before.max() < 1.03 * MOST
    assert abs(before.mean() - 1.0) < 4.5 * before.std() / math.sqrt(n)


@pytest.mark.parametrize("eta", [1.5, 1.0 / 1.5])
def test_facets_that_only_let_through_are_those_that_also_reflect(eta):
    """Up to rounding, total internal reflection and light that would go to the wrong side included."""
    n, alpha = 400, 0.3
    rng = np.random.default_rng(1)
    z, turn = rng.uniform(0.05, 1.0, n), rng.uniform(0.0, 2.0 * math.pi, n)
    batch = np.ones((WEIGHT + 3, n))
    batch[X], batch[Y], batch[Z] = np.sqrt(1.0 - z * z) * np.cos(turn), np.sqrt(1.0 - z * z) * np.sin(turn), z
    batch[RATIO] = rng.uniform(0.5, 1.5, n)
    scratch = np.zeros((N_SCRATCH, n))
    scratch[POINT_U], scratch[POINT_V] = rng.random((2, n))
    let_through(batch, n, 5, EXIT, alpha, eta, 0.25, scratch)
    found = scratch[THROUGH_X : AMOUNT + 1].copy()
    u, v, fx, fy, fz = scratch[[POINT_U, POINT_V, FACET_X, FACET_Y, FACET_Z]]
    facet_numbers(u, v, n, 5, EXIT, batch[RATIO], fx, fy, fz, scratch[FACET_RATIO])
    scratch[FACET_X], scratch[FACET_Y], scratch[FACET_Z] = fx, fy, fz
    meet_dielectric(ROUGH_DIELECTRIC, batch, n, alpha, eta, scratch)
    go_through(ROUGH_DIELECTRIC, batch, n, alpha, eta, scratch)
    share_out(batch, n, 0.25, True, scratch)
    lit = found[-1] > 0.0
    assert lit.sum() > 0 and (eta > 1.0 or not lit.all())
    np.testing.assert_allclose(found[-1], scratch[AMOUNT], rtol=1e-11, atol=1e-15)
    np.testing.assert_allclose(found[:3, lit], scratch[THROUGH_X:AMOUNT, lit], rtol=1e-9, atol=1e-12)


def test_the_dimmer_way_out_gets_fewer_facets():
    """By the root of what is usual there: some 5 % of the light turns back at the bottom of a clear slab."""
    layers = [dielectric(1.5, 0.001), medium(0.1), dielectric(1.0, 0.001)]
    _, split = prepared(Split, make_scene(layers, 10.0, "half"))
    assert split.facets[0, DOWN] == MOST_FACETS
    assert 0.1 * MOST_FACETS < split.facets[0, UP] < 0.3 * MOST_FACETS


@pytest.mark.false_alarm(3e-10)
def test_every_dimension_of_the_lattice_has_a_shift_of_its_own():
    """Uniform and independent, over 2000 replicates: means and covariances to 6.8 sigma, a false alarm in 3e-10."""
    shifts = np.empty((2000, DIMENSIONS))
    for key, row in zip(keys(1, len(shifts)), shifts, strict=True):
        lattice_shifts(key, row)
    z = (shifts - 0.5) * math.sqrt(12.0)
    limit = 6.8 / len(z) ** 0.5
    assert np.abs(z.mean(axis=0)).max() < limit
    assert np.abs(z.T @ z / len(z) - np.eye(DIMENSIONS)).max() < limit
