"""GGX: normalisation, masking, and the density of the visible normals."""

import math

import numpy as np
import pytest
from scipy import integrate, stats

from goniosim._jit import kernel
from goniosim.optics.elementary import sincos_turns
from goniosim.optics.ggx import ggx_density, sample_visible_normal, smith_g1, smith_g1_scaled
from goniosim.optics.random import uniform


@kernel
def _density(sin2, cosine, alpha):
    return ggx_density(sin2, cosine, alpha)


@kernel
def _g1(cosine, alpha):
    return smith_g1(cosine, alpha)


@kernel
def _g1_scaled(height, scale, alpha):
    return smith_g1_scaled(height, scale, alpha)


@kernel
def _visible_normals(x, y, z, alpha, key, normals):
    for i in range(normals.shape[0]):
        sine, cosine = sincos_turns(uniform(key, i))
        normals[i, 0], normals[i, 1], normals[i, 2] = sample_visible_normal(
            x, y, z, alpha, cosine, sine, uniform(key + np.uint64(1), i)
        )


@pytest.mark.parametrize("alpha", [1e-6, 1e-3, 0.2, 1.0])
def test_ggx_is_normalised(alpha):
    # In t = tan(theta) / alpha the integrand is smooth for every width.
    def integrand(t):
        tan = alpha * t
        cosine = 1 / math.sqrt(1 + tan * tan)
        return _density((tan * cosine) ** 2, cosine, alpha) * cosine**4 * 2 * math.pi * tan * alpha

    assert integrate.quad(integrand, 0, np.inf)[0] == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("alpha", [1e-6, 0.2, 1.0, 3.0])
@pytest.mark.parametrize("scale", [1.0, 0.3, 1e-9])
def test_masking_of_a_scaled_direction(alpha, scale):
    for cosine in (1.0, 0.5, 1e-9, 0.0, -0.4, -1.0):
        masking, inverse = _g1_scaled(cosine * scale, scale, alpha)
        assert masking == pytest.approx(_g1(cosine, alpha), rel=1e-14)
        assert inverse == pytest.approx(1.0 / scale, rel=1e-14)


@pytest.mark.parametrize("alpha", [0.05, 0.5, 1.0])
@pytest.mark.parametrize("deg", [0.0, 40.0, 85.0])
def test_smith_masking_conserves_the_projected_area(alpha, deg):
    """The visible facets cover the view: the integral of G1 max(0, w.m) D(m) is cos(theta)."""
    z, x = math.cos(math.radians(deg)), math.sin(math.radians(deg))

    def integrand(phi, u):
        tan2 = alpha**2 * u / (1 - u)
        c = 1 / math.sqrt(1 + tan2)
        s = math.sqrt(tan2) * c
        # du is D cos(theta) d(omega) / (d phi / 2 pi)
        return max(0.0, x * s * math.cos(phi) + z * c) / c / (2 * math.pi)

    area = integrate.dblquad(integrand, 0, 1 - 1e-12, 0, 2 * math.pi, epsabs=1e-6)[0]
    assert _g1(z, alpha) * area == pytest.approx(z, rel=1e-3)


def test_directions_below_the_surface_see_nothing():
    assert _g1(-0.3, 0.2) == 0.0 and _g1(0.0, 0.2) == 0.0
    assert _density(0.5, -0.1, 0.2) == 0.0


@pytest.mark.false_alarm(1e-6, seeds=(1, 101))
@pytest.mark.parametrize("alpha", [1e-3, 0.05, 0.2, 1.0])
@pytest.mark.parametrize("deg", [0.0, 30.0, 60.0, 85.0, 89.9])
def test_visible_normals_have_their_density(alpha, deg, seed):
    """Chi-square of the sampled slopes; false alarm 1e-6.

    In the plane of the stretched slopes m_xy / (alpha m_z) the density of facets is that of
    alpha = 1; bins are equally likely in the radius, equal in the azimuth.
    """
    n = 200_000
    view = math.sin(math.radians(deg)), 0.0, math.cos(math.radians(deg))
    normals = np.empty((n, 3))
    _visible_normals(*view, alpha, np.uint64(seed), normals)
    assert np.abs((normals**2).sum(axis=1) - 1).max() < 1e-14
    assert (normals[:, 2] > 0).all()
    assert (normals @ view).min() > -1e-15
    slopes = normals[:, :2] / normals[:, 2:] / alpha
    u = (lambda r2: r2 / (1 + r2))((slopes**2).sum(axis=1))
    phi = np.arctan2(slopes[:, 1], slopes[:, 0]) % (2 * math.pi)
    rings, sectors = 12, 16
    observed = np.histogram2d(u, phi, bins=[np.linspace(0, 1, rings + 1), np.linspace(0, 2 * math.pi, sectors + 1)])[0]
    expected = n * _visible_probabilities(view, alpha, rings, sectors)
    good = expected > 10
    value = ((observed - expected)[good] ** 2 / expected[good]).sum()
    if not good.all():
        rest_o, rest_e = observed[~good].sum(), expected[~good].sum()
        value += (rest_o - rest_e) ** 2 / max(rest_e, 1.0)
    assert stats.chi2.sf(value, good.sum()) > 1e-6


def _visible_probabilities(view, alpha, rings, sectors):
    """Midpoint integration of G1 max(0, w.m) D / w_z over the bins, in the coordinates (u, phi)."""
    fine = 60
    # With u = sin^2(psi) the slope is alpha tan(psi), and the integrand is bounded.
    edge = np.arcsin(np.sqrt(np.arange(rings + 1) / rings))
    psi = edge[:-1, None] + np.diff(edge)[:, None] * (np.arange(fine) + 0.5) / fine
    width = np.repeat(np.diff(edge) / fine, fine)[:, None]
    psi = psi.ravel()[:, None]
    phi = ((np.arange(sectors * fine) + 0.5) / (sectors * fine) * 2 * math.pi)[None, :]
    # D cos d(omega) = du dphi / 2 pi, hence the density per (u, phi) holds w.m / cos.
    value = np.maximum(0.0, view[0] * alpha * np.tan(psi) * np.cos(phi) + view[2]) * np.sin(2 * psi) * width
    cells = value.reshape(rings, fine, sectors, fine).sum(axis=(1, 3))
    probability = cells / (sectors * fine) * _g1(view[2], alpha) / view[2]
    assert probability.sum() == pytest.approx(1.0, rel=1e-3)
    return probability / probability.sum()
