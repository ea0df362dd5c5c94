"""Sums over the cells of a simulation: albedo, block and RMSE have errors as wide as their scatter.

Under a smooth-looking coat over a white base nearly all light comes back: its amount is known far better than where it
leaves. Cells taken to be independent state four times the scatter of the albedo.
"""

import functools

import numpy as np
import pytest

from goniosim.compare.counts import count
from goniosim.compare.measures import measure, rmse
from goniosim.engine import simulate
from goniosim.sums import noise_of
from reference.scenes import dielectric, lambert, make_scene

SEEDS = 60
# 60 seeds tell a standard deviation to 9.2 %. What is stated exceeds one that is by chance too small by 4 of these with
# a probability of 1.4e-3: the distribution is skewed.
TOLERANCE = 4.0 / (2 * SEEDS) ** 0.5
NAME = "reflection/internal"
BLOCK = np.zeros((12, 24))
BLOCK[2:10, 3:21] = 1.0


@functools.cache
def runs_from(seed):
    scene = make_scene([dielectric(1.5, 0.05), lambert(1.0)], 40.0, rows=12, columns=24)
    return [simulate(scene, rays=10_000, seed=seed + number, threads=1) for number in range(SEEDS)]


@pytest.mark.false_alarm(1.4e-3, seeds=(1, 1001, 2001, 3001))
def test_the_albedo(seed):
    runs = runs_from(seed)
    value, stderr = (np.array(each)[:, 0, 0] for each in zip(*(run.albedo(NAME) for run in runs), strict=True))
    scatter = value.std(ddof=1)
    assert np.sqrt((stderr**2).mean()) == pytest.approx(scatter, rel=TOLERANCE)
    independent = np.mean([(run.components[NAME].stderr[0, 0] ** 2).sum() for run in runs]) ** 0.5
    assert independent > 2.5 * scatter
    # The audit says the same from the scatter of parts.
    audited = np.array([run.audit.stderr["reflected_internal"][0, 0] for run in runs])
    assert np.sqrt((audited**2).mean()) == pytest.approx(np.sqrt((stderr**2).mean()), rel=0.1)


@pytest.mark.false_alarm(1.4e-3, seeds=(1, 1001, 2001, 3001))
def test_the_energy_of_a_block(seed):
    value, variance = [], []
    for run in runs_from(seed):
        part = run.components[NAME]
        value.append((BLOCK * part.energy[0, 0]).sum())
        independent = (BLOCK * part.stderr[0, 0] ** 2).sum()
        variance.append(independent + noise_of(part, 0, int(run.rays[0])).of_sum(BLOCK)[0])
        assert variance[-1] < 0.6 * independent
    assert np.mean(variance) ** 0.5 == pytest.approx(np.std(value, ddof=1), rel=TOLERANCE)


@pytest.mark.false_alarm(4.2e-3, seeds=(1, 1001, 2001, 3001))
@pytest.mark.parametrize("factor", [1.3, 0.8])
def test_the_rmse_and_the_albedo_of_a_comparison(factor, seed):
    """A model that is too bright everywhere is compared with the amount of light, which is known well.

    Three standard deviations, each with a false alarm in 1.4e-3 of the cases.
    """
    runs = runs_from(seed)
    mean = np.mean([run.components[NAME].bsdf for run in runs], axis=0)
    found, debiased = [], []
    for run in runs:
        part = run.components[NAME]
        found.append(measure(factor * mean, part.bsdf, part.bsdf_stderr, run.cells, count(run, NAME)))
        debiased.append((found[-1].squared - found[-1].noise)[0, 0])
    variance = np.mean([each.variance[0, 0] for each in found])
    assert np.sqrt(variance) == pytest.approx(np.std(debiased, ddof=1), rel=TOLERANCE)
    errors = [rmse(each) for each in found]
    scatter = np.std([error.rmse for error in errors], ddof=1)
    assert np.mean([error.stderr for error in errors]) == pytest.approx(scatter, rel=TOLERANCE)
    albedo = np.std([each.albedo_reference[0, 0] for each in found], ddof=1)
    assert np.mean([each.albedo_stderr[0, 0] ** 2 for each in found]) ** 0.5 == pytest.approx(albedo, rel=TOLERANCE)


@pytest.mark.false_alarm(1e-12)
def test_an_absorbed_channel_is_uncertain_where_others_are_not():
    """Strong absorption leaves next to nothing of all but the steepest paths: few of many hits carry the channel.

    Over many seeds that is so in 90 +- 2 % of the cells.
    """
    from reference.scenes import medium

    layers = [dielectric(1.5, 0.3), medium([0.0, 1.0, 60.0]), lambert(0.8)]
    result = simulate(make_scene(layers, 30.0, rows=6, columns=8), rays=20_000, threads=1)
    part = result.components[NAME]
    well_hit = np.broadcast_to(part.hits[0] >= 30, part.uncertain[0].shape[1:])
    assert well_hit.mean() > 0.8
    red, green, blue = (part.uncertain[0, c][well_hit].mean() for c in range(3))
    assert red == green == 0.0 and blue > 0.3
