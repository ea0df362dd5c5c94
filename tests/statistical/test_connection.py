"""The base connection: unbiased in every cell and order, and honest about its error."""

import functools
import math
import threading
import tracemalloc

import numpy as np
import pytest
from scipy import stats

from goniosim.engine import simulate
from goniosim.engine.estimators.connection import Connection, _gamble
from goniosim.engine.layout import DOWN, UP
from goniosim.engine.plan import make_plan
from goniosim.engine.unit import unit_key
from reference.cell_integrals import integrate_cells
from reference.closed_forms import plastic_albedo, plastic_density
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

R = 32
RUNNING = threading.Event()
# 1 - chance of a deviation of 6 or more with 31 degrees of freedom, on both sides.
SIX = 2.0 * stats.t.sf(6.0, R - 1)


def replicates(plan, size, direction=0, seed=1, count=R):
    """Slices of all columns, shape (count, slots, channels, rows, columns)."""
    keys = np.array([unit_key(seed, direction, number) for number in range(count)])
    out = np.full((count, plan.slots[UP, 1], plan.n_distinct, plan.rows, plan.width), np.nan)
    assert Connection(plan, (UP,)).workspace().run(direction, size, keys, out, RUNNING) >= count * size
    return out if plan.width == plan.columns else np.concatenate([out, out[..., ::-1]], axis=-1)


def mean_and_variance(slices):
    """Of the mean over replicates."""
    return slices.mean(axis=0), slices.var(axis=0, ddof=1) / len(slices)


def blocks(cells, rows=6, columns=12):
    """Sums over blocks of so many cells."""
    shape = (cells.shape[-2] // rows, rows, cells.shape[-1] // columns, columns)
    return cells.reshape(*cells.shape[:-2], *shape).sum(axis=(-3, -1))


SMOOTH = [dielectric(1.5), medium([0.2, 0.2, 0.6]), lambert([0.5, 0.5, 0.9])]


@pytest.mark.false_alarm(6e-4, seeds=(1, 101, 201))
@pytest.mark.parametrize("columns", [8, 7])
@pytest.mark.parametrize("parametrization", ["classic", "half"])
def test_a_smooth_top_agrees_with_its_closed_form(parametrization, columns, seed):
    """Every cell of 4 slices, of two channels, and their totals: 6 sigma of t with 31 degrees of freedom.

    False-alarm rate 500 `SIX` = 6e-4 at most. Totals are known to 1e-3.
    """
    plan = make_plan(make_scene(SMOOTH, [20.0, 60.0], parametrization, rows=9, columns=columns))
    slices = replicates(plan, 16384, direction=1, seed=seed)[:, 0]
    mean, variance = mean_and_variance(slices)
    for channel, (rho, tau) in enumerate(((0.5, 0.2), (0.9, 0.6))):
        exact = integrate_cells(plastic_density(1.5, rho, tau), 60.0, 9, columns, parametrization)
        dark = exact == 0.0
        assert (mean[channel][dark] == 0.0).all() and not dark.all()
        z = (mean[channel] - exact)[~dark] / np.sqrt(variance[channel][~dark])
        assert abs(z).max() < 6.0
        total = slices[:, channel].sum(axis=(1, 2))
        error = total.std(ddof=1) / R**0.5
        assert abs(total.mean() - exact.sum()) < 6.0 * error < 6e-3 * exact.sum()


@pytest.mark.false_alarm(8e-6, seeds=(1, 10_001))
@pytest.mark.parametrize(("size", "eta", "count"), [(1, 1.5, 3000), (16, 2.5, 800)])
def test_small_replicates_have_no_bias(size, eta, count, seed):
    """Neither from means that share draws, which shows with one path each, nor from a series cut where it is faint.

    4.5 sigma of a mean over so many replicates: false-alarm rate 8e-6.
    """
    plan = make_plan(make_scene([dielectric(eta), lambert(0.999)], 30.0, rows=1, columns=1))
    total = replicates(plan, size, seed=seed, count=count).sum(axis=(1, 2, 3, 4))
    exact = plastic_albedo(math.cos(math.radians(30.0)), eta, 0.999)
    assert abs(total.mean() - exact) < 4.5 * total.std(ddof=1) / count**0.5 < 0.1 * exact


def test_roulette_with_what_is_faint_is_fair():
    """Over chances in equal steps to rounding; light that is not faint in some channel stays."""
    light, threshold = np.array([0.02, 0.05]), np.array([0.1, 0.1])
    kept = [_gamble(light, threshold, (number + 0.5) / 1000.0) for number in range(1000)]
    np.testing.assert_allclose(np.mean(kept, axis=0), light, rtol=1e-12)
    assert np.unique(kept, axis=0).tolist() == [[0.0, 0.0], [0.04, 0.1]]
    assert _gamble(light, np.array([0.1, 0.05]), 0.999) is light


# Layers; the second refracts nothing from grazing directions outside.
ROUGH = {
    "plastic": [dielectric(1.5, 0.2), medium([0.1, 0.0, 0.5]), lambert([0.0, 0.9, 0.5])],
    "light top": [dielectric(0.75, 0.2), medium([0.1, 0.0, 0.5]), lambert([0.0, 0.9, 0.5])],
}


every_rough = pytest.mark.parametrize(
    ("name", "parametrization"), [(name, kind) for name in ROUGH for kind in ("classic", "half")]
)


@functools.cache
def rough(name, parametrization, seed=1):
    """Replicates of a connected scene with orders, its plan, and its analog result."""
    scene = make_scene(ROUGH[name], 55.0, parametrization, rows=6, columns=8, orders=4)
    plan = make_plan(scene)
    return (
        replicates(plan, 512, seed=seed),
        plan,
        simulate(scene, rays=300_000, seed=seed + 2, estimator="analog").components["reflection/internal"],
    )


@pytest.mark.false_alarm(6e-4, seeds=(1, 101, 201))
@every_rough
def test_rough_tops_agree_with_the_analog_engine(name, parametrization, seed):
    """In total and by order, in all cells that the analog engine hit 100 times, and in their sums.

    Its errors are larger by far, and nearly normal: 5 sigma in about 1000 cells and 24 sums, false-alarm rate 6e-4.
    """
    slices, plan, analog = rough(name, parametrization, seed)
    parts = [(analog, slices.sum(axis=1)), *zip(analog.orders.values(), np.moveaxis(slices, 1, 0), strict=True)]
    assert len(parts) == 5
    for component, found in parts:
        mean, variance = mean_and_variance(found[:, plan.position])
        z = (mean - component.energy[0]) / np.sqrt(variance + component.stderr[0] ** 2 + 1e-300)
        assert (abs(z[:, component.hits[0] >= 100]) < 5.0).all()
        total = found[:, plan.position].sum(axis=(2, 3))
        bar = np.sqrt(total.var(axis=0, ddof=1) / R + (component.stderr[0] ** 2).sum(axis=(1, 2)) + 1e-300)
        assert (abs(total.mean(axis=0) - component.energy[0].sum(axis=(1, 2))) < 5.0 * bar).all()


@every_rough
def test_a_channel_that_the_base_absorbs_is_black_to_the_last_bit(name, parametrization):
    slices, plan, _ = rough(name, parametrization)
    assert (slices[:, :, plan.position[0]] == 0.0).all()
    assert (slices[:, :, plan.position[1:]].sum(axis=(2, 3, 4)) > 0.0).all()


@pytest.mark.parametrize("name", ROUGH)
def test_orders_add_up_to_the_whole(name):
    """With the same keys the two differ by what is left to chance alone: 1e-3 of the energy at most."""
    whole, split = (
        replicates(make_plan(make_scene(ROUGH[name], 30.0, rows=4, columns=6, **orders)), 512, count=4)
        for orders in ({}, {"orders": 3})
    )
    assert whole.shape[1] == 1 and split.shape[1] == 3
    np.testing.assert_allclose(split.sum(axis=1), whole[:, 0], rtol=1e-3)


def test_a_replicate_depends_on_its_key_alone():
    plan = make_plan(make_scene(ROUGH["plastic"], [0.0, 40.0], "half", rows=5, columns=6))
    together = replicates(plan, 512, direction=1, count=3)
    keys = np.array([unit_key(1, 1, number) for number in range(3)])
    alone = np.empty((1, 1, plan.n_distinct, 5, 3))
    workspace = Connection(plan, (UP,)).workspace()
    for number in (2, 0, 1):
        workspace.run(1, 512, keys[number : number + 1], alone, RUNNING)
        np.testing.assert_array_equal(alone[0], together[number][..., :3])
        workspace.run(0, 600, keys[number : number + 1], alone, RUNNING)
    assert (together[0] != together[1]).any(axis=(0, 1)).any()


@pytest.mark.false_alarm(1e-6, seeds=(0, 1000))
@pytest.mark.parametrize(("parametrization", "bound"), [("classic", 0.2), ("half", 0.2)])
def test_the_scatter_of_seeds_is_what_replicates_state(parametrization, bound, seed):
    """40 seeds of 8 replicates each: variance over seeds over the mean stated one.

    Replicates so small that cells hardly share an error: the ratio, averaged over 54 cells, scatters by less than
    4 %. False-alarm rate below 1e-6; a share of the light paths common to all seeds or replicates would show.
    """
    plan = make_plan(make_scene(ROUGH["plastic"], 50.0, parametrization, rows=9, columns=12))
    slices = np.array([replicates(plan, 64, seed=seed + n, count=8)[:, 0, -1, :, :6] for n in range(40)])
    seen = slices.any(axis=(0, 1))
    stated = (slices.var(axis=1, ddof=1) / 8).mean(axis=0)[seen]
    ratio = slices.mean(axis=1).var(axis=0, ddof=1)[seen] / stated
    assert ratio.mean() == pytest.approx(1.0, abs=bound)


def test_a_run_that_is_stopped_ends_at_once():
    plan = make_plan(make_scene(ROUGH["plastic"], 50.0, rows=2, columns=2))
    stop = threading.Event()
    stop.set()
    out = np.empty((1, 1, plan.n_distinct, 2, 1))
    assert Connection(plan, (UP,)).workspace().run(0, 1 << 22, [unit_key(1, 0, 0)], out, stop) is None


def test_it_takes_the_memory_that_it_says():
    plan = make_plan(make_scene(ROUGH["plastic"], 50.0, "half"))
    estimator = Connection(plan, (UP,))
    out = np.empty((1, 1, plan.n_distinct, plan.rows, plan.width))
    assert plan.geometry and estimator.workspace().run(0, 64, [unit_key(1, 0, 0)], out, RUNNING)
    tracemalloc.start()
    estimator.workspace().run(0, 64, [unit_key(1, 0, 0)], out, RUNNING)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    shared, own = estimator.memory
    assert shared == 0 and 0.5 * own < peak < 1.1 * own


def test_it_refuses_all_but_one_dielectric_over_a_lambertian_base():
    def refusal(*layers, sides=(UP,)):
        return Connection.refusal(make_plan(make_scene(list(layers), 30.0)), sides)

    assert refusal(dielectric(1.5), lambert(0.5)) is None
    assert refusal(dielectric(0.75, 0.2), medium(0.1), lambert(0.5)) is None
    for refused in (
        refusal(lambert(0.5)),
        refusal(dielectric(1.5), dielectric(1.3, 0.1), lambert(0.5)),
        refusal(dielectric(1.5), conductor(1.45, 1.0, 0.2)),
        refusal(dielectric(1.5), dielectric(1.0), sides=(UP, DOWN)),
        refusal(dielectric(1.5), dielectric(1.0), sides=(DOWN,)),
    ):
        assert "single dielectric interface over a Lambertian base" in refused


# --- slow -------------------------------------------------------------------------------------

STUDY = [dielectric(1.5, 0.05), medium([0.05, 0.1, 0.4]), lambert([0.1, 0.6, 0.2])]
COVERED = stats.t.cdf(2.0, R - 1) - stats.t.cdf(-2.0, R - 1)


@pytest.mark.slow
@pytest.mark.false_alarm(3e-5, seeds=(0, 10_000))
@pytest.mark.parametrize(
    ("parametrization", "size", "seeds"),
    [("classic", 512, 2000), ("classic", 4096, 500), ("half", 512, 200), ("half", 2048, 60)],
)
def test_seeds_are_covered_as_often_as_students_t_says(parametrization, size, seeds, seed):
    """Deviations from the mean of all seeds, in cells above 3 % of the peak and in blocks of 6 by 12 cells.

    In the worst case all cells of a seed share one error, and as many deviations as seeds are independent: 4.5
    sigma of a share and of a variance then. False-alarm rate 7e-6 each, of four.
    """
    # On classic slices a column tells all: those of one block are enough.
    columns = 12 if parametrization == "classic" else 360
    plan = make_plan(make_scene(STUDY, 60.0, parametrization, columns=columns))
    area = np.maximum(plan.geometry[0].projected_solid_angle, 1e-300)
    found = {"cells": [], "blocks": []}
    for number in range(seeds):
        slices = replicates(plan, size, seed=seed + number)[:, 0]
        found["cells"].append(mean_and_variance(slices[..., : plan.width]))
        found["blocks"].append(mean_and_variance(blocks(slices)))
    bsdf = np.mean([mean for mean, _ in found["cells"]], axis=0) / area[:, : plan.width]
    bright = (bsdf > 0.03 * bsdf.max(axis=(1, 2), keepdims=True)) & plan.geometry[0].valid[:, : plan.width]
    means = np.array([mean for mean, _ in found["blocks"]]).mean(axis=0)
    energetic = means > 1e-5 * means.sum(axis=(1, 2), keepdims=True)
    for name, counted in (("cells", bright), ("blocks", energetic)):
        mean, variance = (np.array(part)[:, counted] for part in zip(*found[name], strict=True))
        deviation = (mean - mean.mean(axis=0)) / np.sqrt(1.0 - 1.0 / seeds)
        share = (abs(deviation) < 2.0 * np.sqrt(variance)).mean()
        ratio = ((deviation**2).mean(axis=0) / variance.mean(axis=0)).mean()
        print(f"{parametrization} {size} {name}: |z| < 2 {share:.4f} (t: {COVERED:.4f}), true / stated {ratio:.3f}")
        assert share == pytest.approx(COVERED, abs=4.5 * (COVERED * (1.0 - COVERED) / seeds) ** 0.5)
        assert ratio == pytest.approx(1.0, abs=4.5 * (2.0 / seeds) ** 0.5)


def against_analog(scene, size, rays, seed):
    """Standardised deviations of blocks (a tenth of the columns, a fifteenth of the rows) and of totals."""
    plan = make_plan(scene)
    result = simulate(scene, rays=rays, seed=seed + 6, estimator="analog")
    component, audit = result.components["reflection/internal"], result.audit
    for direction in range(len(plan.theta_deg)):
        slices = replicates(plan, size, direction, seed)[:, 0][:, plan.position]
        shape = (plan.rows // 15, plan.columns // 30)
        mean, variance = mean_and_variance(blocks(slices, *shape))
        energy, squares = (blocks(a[direction], *shape) for a in (component.energy, component.stderr**2))
        counted = blocks(component.hits[direction], *shape) >= 1000
        yield ((mean - energy) / np.sqrt(variance + squares + 1e-300))[:, counted].ravel()
        total, entry = slices.sum(axis=(2, 3)), "reflected_internal"
        bar = np.hypot(total.std(axis=0, ddof=1) / R**0.5, audit.stderr[entry][direction]) + 1e-150
        yield (total.mean(axis=0) - audit.energy[entry][direction]) / bar


@pytest.mark.slow
@pytest.mark.false_alarm(3e-3, seeds=(1, 101, 201))
@pytest.mark.parametrize("parametrization", ["classic", "half"])
def test_blocks_of_the_study_agree_with_the_analog_engine(parametrization, seed):
    """30, 60 and 80 degrees, 450 blocks and 3 channels each: rms 1 +- .15, none beyond 5 (false-alarm rate 2e-3).

    Nine totals, none beyond 4 (false-alarm rate 6e-4).
    """
    scene = make_scene(STUDY, [30.0, 60.0, 80.0], parametrization)
    for number, z in enumerate(against_analog(scene, 512, 16_000_000, seed)):
        print(parametrization, number, f"rms {(z**2).mean() ** 0.5:.3f}, largest {abs(z).max():.2f}")
        if number % 2:
            assert abs(z).max() < 4.0
        else:
            assert (z**2).mean() ** 0.5 == pytest.approx(1.0, abs=0.15) and abs(z).max() < 5.0


@pytest.mark.slow
@pytest.mark.false_alarm(3e-4, seeds=(1, 101))
@pytest.mark.parametrize("parametrization", ["classic", "half"])
@pytest.mark.parametrize(
    "layers",
    [
        [dielectric(1.5, 0.001), medium(0.1), lambert(1.0)],
        [dielectric(1.5, 1.0), medium(0.1), lambert(0.6)],
        [dielectric(2.5, 0.5), lambert(1.0)],
        [dielectric(0.75), lambert(0.6)],
        [dielectric(0.75, 0.5), medium(0.1), lambert(0.6)],
        [dielectric(1.3, 0.2), medium(6.0), lambert(0.6)],
    ],
    ids=["narrow", "wide", "dense", "light", "light and rough", "dark"],
)
def test_edges_agree_with_the_analog_engine(layers, parametrization, seed):
    """0, 50 and 85 degrees: 450 blocks and 3 channels each, none beyond 5.5 (false-alarm rate 2e-4 a test).

    Nine totals, none beyond 4.5 (6e-5).

    At 50 and 85 degrees no light enters a smooth top of index 0.75.
    """
    scene = make_scene(layers, [0.0, 50.0, 85.0], parametrization, rows=30, columns=60)
    for number, z in enumerate(against_analog(scene, 2048, 8_000_000, seed)):
        largest = abs(z).max(initial=0.0)
        print(parametrization, number, f"{z.size} deviations, largest {largest:.2f}")
        assert largest < (4.5 if number % 2 else 5.5)
