"""Every cell of a slice against the integrated density: sampled and integrated light.

Each chi-square is allowed 4 sigma on either side: a right engine fails one with probability 6.3e-5, and any of the ten
or eight of a test (cells and blocks of cells, at each angle) with ten or eight times as much. Three seeds must agree.
"""

import itertools

import numpy as np
import pytest

from reference import checks
from reference.closed_forms import reflection_density
from reference.scenes import conductor, dielectric

THETAS = [0, 30, 60, 85, 89]
ALPHAS = [0.001, 0.2, *(pytest.param(alpha, marks=pytest.mark.slow) for alpha in (0.05, 1.0))]
SLICES = ["classic", "half"]
RAYS = 2_000_000


def assert_within_four_sigma(chi_squares):
    for found in itertools.chain(*chi_squares):
        assert abs(found.sigmas) < 4, f"{chi_squares}"


@pytest.mark.false_alarm(6.3e-4, seeds=(11, 111, 211))
@pytest.mark.parametrize("parametrization", SLICES)
def test_smooth_plastic(parametrization, seed):
    assert_within_four_sigma(checks.plastic_cells(THETAS, parametrization, RAYS, seed))


@pytest.mark.false_alarm(6.3e-4, seeds=(12, 112, 212))
@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("parametrization", SLICES)
def test_rough_conductor(parametrization, alpha, seed):
    assert_within_four_sigma(checks.conductor_cells(alpha, THETAS, parametrization, RAYS, seed))


@pytest.mark.false_alarm(5.1e-4, seeds=(13, 113, 213))
@pytest.mark.parametrize("eta", [1.5, 1.0 / 1.5])
@pytest.mark.parametrize("alpha", ALPHAS)
def test_transmission_of_a_rough_interface(alpha, eta, seed):
    """Refraction into a half-space, from both sides of the interface."""
    assert_within_four_sigma(checks.transmission_cells(alpha, eta, [0, 30, 60, 85], RAYS, seed))


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("parametrization", SLICES)
@pytest.mark.parametrize(
    "top, n", [(conductor(1.45, 1.0), 1.45 + 1.0j), (dielectric(1.5), 1.5)], ids=["conductor", "dielectric"]
)
def test_integrated_direct_reflection(top, n, parametrization, alpha):
    """A quadrature, not a sample: its error bar must cover its error in every cell."""
    top["interface"]["alpha"] = alpha
    energy, stderr, exact = checks.direct_cells(top, reflection_density(alpha, n), THETAS, parametrization, 45, 180)
    assert (np.abs(energy - exact) <= 3.0 * stderr + 3e-7 * exact + 1e-11).all()
    np.testing.assert_allclose(energy.sum(axis=(1, 2)), exact.sum(axis=(1, 2)), rtol=1e-6)
