"""The error bars are honest: over many seeds they are as wide as the scatter."""

import numpy as np
import pytest

from goniosim.engine import simulate
from reference.cell_integrals import integrate_cells
from reference.checks import ENOUGH_HITS, many_seeds
from reference.closed_forms import plastic_density, reflection_density
from reference.scenes import conductor, dielectric, lambert, make_scene, medium
from reference.seeds import many_runs

SEEDS = 100
RAYS = 300_000

# Layers, incident angle, parametrization and exact flux density of the internal reflection.
CASES = {
    "plastic": (
        [dielectric(1.5), medium(0.2), lambert(0.5)], 60, "classic", plastic_density(1.5, 0.5, 0.2)
    ),
    "metal": (
        [dielectric(1.0), conductor(1.45, 1.0, 0.3)], 45, "half", reflection_density(0.3, 1.45 + 1.0j)
    ),
}  # fmt: skip
SLAB = [dielectric(1.5, 0.2), medium([0.05, 0.1, 0.8]), dielectric(1.0, 0.1)]


@pytest.mark.false_alarm(1.3e-4, seeds=(0, 1000, 2000))
@pytest.mark.parametrize("case", CASES)
def test_deviations_from_the_truth(case, seed):
    """Standardised deviations from the exact cell averages have mean 0 and standard deviation 1.

    The error bar is averaged over the seeds, for that of a single run is
    correlated with its deviation (a cell that by chance caught more paths has
    a wider one). With more than 5e4 deviations, 2 % is more than 6 sigma of
    their standard deviation; the mean is allowed 4 sigma of t with 99 degrees
    of freedom: false alarm 1.3e-4.
    """
    layers, theta, parametrization, density = CASES[case]
    component = "reflection/internal"
    energy, stderr, hits = many_seeds(layers, theta, component, parametrization, RAYS, SEEDS, first=seed)
    exact = integrate_cells(density, theta, *hits.shape[1:], parametrization)
    counted = hits.mean(axis=0) >= ENOUGH_HITS
    bar = np.sqrt((stderr[:, 0] ** 2).mean(axis=0))
    z = (energy[:, 0] - exact)[:, counted] / bar[counted]
    assert z.size > 50_000
    assert np.std(z) == pytest.approx(1.0, abs=0.02)
    # The cells of a run share its paths; the runs share nothing.
    per_run = z.mean(axis=1)
    assert abs(per_run.mean()) < 4.0 * per_run.std(ddof=1) / np.sqrt(SEEDS)


@pytest.mark.false_alarm(2e-4, seeds=(0, 1000, 2000))
@pytest.mark.parametrize("component", ["reflection/internal", "transmission"])
def test_error_bars_of_single_runs(component, seed):
    """Each run's own error bar, in all channels, where no closed form exists.

    Deviations are taken from the mean over the seeds, which shrinks them by
    sqrt(1 - 1/100). The bar of a single run is correlated with its deviation:
    n hits widen the distribution by about 7 / (8 n), 3 % at 30 hits and 1 to
    2 % over all cells. With 1e4 deviations and more, 0.7 % is one sigma of the
    standard deviation, so that 5 % is above 4: false alarm 6.3e-5 for each of
    three channels.
    """
    energy, stderr, hits = many_seeds(SLAB, 30, component, "classic", RAYS, SEEDS, 18, 36, first=seed)
    counted = hits.mean(axis=0) >= ENOUGH_HITS
    z = (energy - energy.mean(axis=0))[:, :, counted] / stderr[:, :, counted] / np.sqrt(1.0 - 1.0 / SEEDS)
    assert z[:, 0].size > 10_000
    for channel in range(3):
        assert np.std(z[:, channel]) == pytest.approx(1.0, abs=0.05)


@pytest.mark.false_alarm(5e-5, seeds=(1, 1001, 2001))
def test_error_bars_of_the_audit(seed):
    """They come from 64 parts of the rays: as wide as the scatter, and themselves uncertain by 1/sqrt(2 63) = 9 %.

    100 seeds: the scatter of a standard deviation is 7 % of it; 4.5 sigma each, false-alarm rate 1.1e-5 each of four
    (the distribution is skewed).
    """
    scene = make_scene(SLAB, 30, rows=2, columns=2)
    audits = [simulate(scene, rays=20_000, seed=seed + n, threads=1).audit for n in range(100)]
    for entry in ("transmitted", "absorbed_media"):
        energy, stderr = (np.array([getattr(a, part)[entry][0, 0] for a in audits]) for part in ("energy", "stderr"))
        bar = np.sqrt((stderr**2).mean())
        assert energy.std(ddof=1) == pytest.approx(bar, rel=4.5 * 0.07)
        assert stderr.std(ddof=1) == pytest.approx(bar / np.sqrt(2.0 * 63.0), rel=4.5 * 0.07)


@pytest.mark.slow
@pytest.mark.false_alarm(1e-4, seeds=(10, 1010, 2010))
@pytest.mark.parametrize("estimator", ["operator", "split"])
def test_light_that_is_caught(estimator, seed):
    """24 runs that all state about the same error, about as large as their scatter; in the mean they are right.

    Squared deviations over the stated ones are 3 in the mean with a chance of 2.3e-5 (t with 31 degrees of freedom),
    for either way out; one of the stated errors is twice the median with one below 1e-6; independent paths, whose error
    dominates, within 4.5 sigma: 1e-5. Weights without a bound had stated errors of 2.4 to 22 times the median.
    """
    layers = [dielectric(4.0, 0.03), dielectric(1.0, 0.03)]
    components, _ = many_runs(layers, 0.0, estimator, 65536, 24, seed, 6, 8)
    expected = simulate(make_scene(layers, 0.0, rows=6, columns=8), rays=2_000_000, seed=seed, estimator="analog")
    for name in ("reflection/internal", "transmission"):
        found, stated = components[name].albedo[:, 0], components[name].albedo_stderr[:, 0]
        assert stated.max() < 2.0 * np.median(stated)
        assert np.mean(((found - found.mean()) / stated) ** 2) < 3.0
        right = expected.components[name]
        error = np.hypot(found.std(ddof=1) / np.sqrt(24), right.albedo_stderr[0, 0])
        assert abs(found.mean() - right.albedo[0, 0]) < 4.5 * error
