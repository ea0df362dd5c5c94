"""Light that walks for long: what a path costs is bounded, and what fewer paths say is right, as are its errors."""

import threading
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from goniosim.engine.estimators.split import Split
from goniosim.engine.splitting.effort import CROWD, ROUNDS, Effort
from goniosim.engine.splitting.layout import EVENTS, STAGES
from goniosim.engine.splitting.walk import EVENTS_PER_STAGE
from goniosim.engine.unit import BATCH
from reference.closed_forms import fresnel_dielectric, smooth_metal, smooth_slab
from reference.replicates import keys, make_replicates, prepared, totals
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

# Hardly a photon in 10^5 is lost at the base.
MIRROR = [dielectric(1.5), conductor(0.001, 1000.0)]
SILVER = [dielectric(1.5), conductor(0.05, 20.0)]
SLAB = [dielectric(1.5), dielectric(1.0)]
TWO_SLABS = [dielectric(1.5), dielectric(1.0), dielectric(1.5), dielectric(1.0)]
# A white base below a gap of low index: of the light between them, little gets out at a time.
CAUGHT = [dielectric(0.2), dielectric(5.0), lambert(1.0)]


def small(layers, theta):
    return make_scene(layers, theta, rows=6, columns=12)


def energies(layers, theta, size, seed, count=32):
    """Energies of each replicate by way out, shape (count, ways out)."""
    plan, split = prepared(Split, small(layers, theta))
    found = make_replicates(plan, split, size, seed, count)
    return plan.light[0][2], totals(plan, found)


def exact(layers, cosine):
    """What leaves into each way out after it has entered."""
    if layers is CAUGHT:
        return np.array([1.0 - fresnel_dielectric(cosine, 0.2)])
    if layers is SLAB:
        return np.array(smooth_slab(cosine, 1.5)[1:])
    if layers is TWO_SLABS:
        first, inside, through = smooth_slab(cosine, 1.5)
        echo = (first + inside) * through / (1.0 - (first + inside) ** 2)
        return np.array([inside + through * echo, through * through / (1.0 - (first + inside) ** 2)])
    eta, kappa = (0.001, 1000.0) if layers is MIRROR else (0.05, 20.0)
    return np.array(smooth_metal(cosine, 1.5, eta, kappa)[1:])


@pytest.mark.false_alarm(1e-9)
@pytest.mark.parametrize(
    ("layers", "theta", "size"),
    [(MIRROR, 89.9, 4096), (SILVER, 89.999, 4096), (SLAB, 89.9, 2048), (TWO_SLABS, 89.9, 1024), (CAUGHT, 0.0, 256)],
    ids=["mirror", "silver", "slab", "two slabs", "caught"],
)
def test_fewer_paths_are_not_biased(layers, theta, size):
    """Totals of 32 replicates against closed forms, by Student's t: each of two ways out fails once in 2e9."""
    cosine, found = energies(layers, theta, size, 11)
    wanted = exact(layers, cosine)
    t = (found.mean(axis=0) - wanted) / (found.std(axis=0, ddof=1) / np.sqrt(len(found)))
    # Or it would not see much.
    assert (found.std(axis=0, ddof=1) < 0.4 * wanted).all()
    assert (2.0 * stats.t(len(found) - 1).sf(np.abs(t)) > 5e-10).all()


@pytest.mark.parametrize("layers", [MIRROR, SLAB, TWO_SLABS, CAUGHT], ids=["mirror", "slab", "two slabs", "caught"])
def test_a_path_costs_no_more_towards_the_horizon(layers):
    """Events of a replicate; what is left of chance is whether a few paths more or less get caught."""
    most = ROUNDS * (2 * len(layers) + 1)
    for theta in (0.0, 89.0, 89.9, 89.999):
        plan, split = prepared(Split, small(layers, theta))
        out = np.empty((1, int(split.slots[:, 1].sum()), plan.n_distinct, plan.rows, plan.width))
        events = split.workspace().run(0, 1024, keys(3, 1), out, threading.Event())
        assert events < 2.0 * most * 1024


@pytest.mark.parametrize(("layers", "theta"), [(SLAB, 89.99), (CAUGHT, 0.0)], ids=["slab", "caught"])
def test_every_path_would_cost_more(layers, theta):
    """Followed to its end, each path and each of its branches takes several times what is granted."""
    plan, split = prepared(Split, small(layers, theta))
    split.effort = Effort.unbounded(1)
    workspace = split.workspace()
    workspace.begin(BATCH)
    granted = 2 * ROUNDS * (2 * len(layers) + 1) * BATCH
    crowd = split.effort.crowds[0]
    while not workspace.advance(0, keys(3, 1)[0], 1 << 16, crowd) and workspace.state[EVENTS] < granted:
        pass
    assert workspace.state[EVENTS] >= granted


@pytest.mark.parametrize("theta", [0.0, 60.0, 85.0])
def test_usual_paths_are_all_followed(theta):
    gold = conductor([0.2, 0.4, 1.4], [3.9, 2.4, 1.6], 0.1)
    for layers in (
        MIRROR,
        SLAB,
        [dielectric(1.5, 0.1), medium(0.1), gold],
        [dielectric(1.5, 0.05), lambert(1.0)],
        [dielectric(1.3, 0.1), dielectric(1.6), dielectric(1.0, 0.3)],
    ):
        _, split = prepared(Split, small(layers, theta))
        assert split.effort.followed[0] == 1.0
        assert split.effort.crowds[0] == CROWD * BATCH


@pytest.mark.false_alarm(3e-9)
def test_at_least_one_path_is_followed():
    """Replicates that follow none would agree on darkness, without any error. The mean of 200 within 6.2 sigma of t."""
    plan, split = prepared(Split, small(MIRROR, 60.0))
    split.effort = replace(split.effort, followed=np.array([0.5 / 4096]))
    found = totals(plan, make_replicates(plan, split, 4096, 5, 200))[:, 0]
    wanted = exact(MIRROR, plan.light[0][2])[0]
    assert found.min() > 0.0
    assert found.mean() == pytest.approx(wanted, abs=6.2 * found.std(ddof=1) / np.sqrt(len(found)))


def test_a_call_of_few_rays_ends_after_so_many_stages():
    """One path that goes on and on: its batches of one take far longer than an event in a full one."""
    _, split = prepared(Split, small(MIRROR, 89.999))
    workspace = split.workspace()
    workspace.begin(1)
    budget = 1 << 12
    assert not workspace.advance(0, keys(3, 1)[0], budget, CROWD * BATCH)
    assert workspace.state[STAGES] == budget // EVENTS_PER_STAGE


@pytest.mark.slow
@pytest.mark.false_alarm(2e-6)
@pytest.mark.parametrize(("layers", "theta"), [(MIRROR, 89.99), (SLAB, 89.9)], ids=["mirror", "slab"])
def test_the_scatter_of_seeds_is_what_fewer_paths_state(layers, theta):
    """150 seeds of 32 replicates: t = (mean - exact) / error has the variance of Student's t of 31.

    The mean of t^2 has an error of 12 %, its limit is 6 of them: errors a quarter too small would be seen. A false
    alarm in 1e-6 for each way out, as the sum of squares is a little skew.
    """
    plan, split = prepared(Split, small(layers, theta))
    wanted = exact(layers, plan.light[0][2])
    found = np.array([totals(plan, make_replicates(plan, split, 1024, seed)) for seed in range(150)])
    count = found.shape[1]
    t = (found.mean(axis=1) - wanted) / (found.std(axis=1, ddof=1) / np.sqrt(count))
    square = np.mean(t**2, axis=0) / stats.t(count - 1).var()
    assert (np.abs(square - 1.0) < 6.0 * np.sqrt((2.0 + 6.0 / (count - 5)) / len(t))).all()
