"""Fresnel, Lambert and media: closed forms, limits and the density of the sampler."""

import math

import numpy as np
import pytest
from scipy import integrate, stats

from goniosim._jit import kernel
from goniosim.optics.fresnel import fresnel_conductor, fresnel_dielectric
from goniosim.optics.lambert import sample_cosine
from goniosim.optics.medium import path_length, transmittance
from goniosim.optics.random import uniform


@kernel
def _dielectric(c, eta):
    return fresnel_dielectric(c, eta)


@kernel
def _conductor(c, eta, kappa):
    return fresnel_conductor(c, eta, kappa)


@kernel
def _attenuation(tau, cosine):
    return transmittance(tau, path_length(cosine))


@kernel
def _cosines(key, directions):
    for i in range(directions.shape[0]):
        directions[i, 0], directions[i, 1], directions[i, 2] = sample_cosine(
            uniform(key, i), uniform(key + np.uint64(1), i)
        )


def test_dielectric_at_normal_incidence_and_brewster():
    assert _dielectric(1.0, 1.5)[0] == pytest.approx(0.04, rel=1e-14)
    theta = math.atan(1.5)
    sine = math.sin(theta)
    # At the Brewster angle only the s polarisation is reflected.
    t = math.sqrt(1.5**2 - sine**2)
    r_s = (math.cos(theta) - t) / (math.cos(theta) + t)
    assert _dielectric(math.cos(theta), 1.5)[0] == pytest.approx(0.5 * r_s**2)


def test_dielectric_is_the_same_from_both_sides():
    for c in np.linspace(0.01, 1, 50):
        reflectance, cos_t = _dielectric(c, 1.5)
        back, cos_i = _dielectric(cos_t, 1 / 1.5)
        assert back == pytest.approx(reflectance, rel=1e-10)
        assert cos_i == pytest.approx(c, rel=1e-10)


@pytest.mark.parametrize("c", [0.0, 0.1, 0.7])
def test_total_reflection(c):
    assert _dielectric(c, 1 / 1.5) == (1.0, 0.0)


def test_fresnel_average_of_glass():
    mean = integrate.quad(lambda c: 2 * c * _dielectric(c, 1.5)[0], 0, 1)[0]
    assert mean == pytest.approx(0.091778, abs=5e-7)


def test_conductor_against_the_complex_formula():
    for eta, kappa in [(0.2, 3.4), (1.2 / 1.5, 1 / 1.5), (1.45, 0.01), (1.9, 0.0), (1e3, 1e6), (1e-3, 0.0)]:
        for c in np.linspace(0.001, 1, 40):
            r = complex(eta, kappa)
            g = np.sqrt(r * r - (1 - c * c))
            s, p = (c - g) / (c + g), (r * r * c - g) / (r * r * c + g)
            assert _conductor(c, eta, kappa) == pytest.approx(0.5 * (abs(s) ** 2 + abs(p) ** 2), rel=1e-7, abs=1e-12)


def test_conductor_without_absorption_is_a_dielectric():
    for c in np.linspace(0.0, 1, 50):
        for eta in (0.6, 1.5):
            assert _conductor(c, eta, 0.0) == pytest.approx(_dielectric(c, eta)[0], abs=1e-10)


def test_fresnel_curves_of_the_paper_cross():
    """Red and green reflectances of (1.2 + i kappa) / 1.5 cross at 51.15 degrees (Bati et al. 2019, Fig. 14)."""

    def difference(deg):
        c = math.cos(math.radians(deg))
        return _conductor(c, 1.2 / 1.5, 1 / 1.5) - _conductor(c, 1.2 / 1.5, 0.01 / 1.5)

    assert difference(51.1) * difference(51.2) < 0


@pytest.mark.false_alarm(2e-6, seeds=(1, 101))
def test_cosine_directions_have_their_density(seed):
    """Kolmogorov-Smirnov of cos^2 and of the azimuth; false alarm 2e-6."""
    directions = np.empty((200_000, 3))
    _cosines(np.uint64(seed), directions)
    assert np.abs((directions**2).sum(axis=1) - 1).max() < 1e-14
    assert stats.kstest(directions[:, 2] ** 2, "uniform").pvalue > 1e-6
    assert stats.kstest(np.arctan2(directions[:, 1], directions[:, 0]) / (2 * math.pi) % 1, "uniform").pvalue > 1e-6


@pytest.mark.parametrize("tau, cosine", [(0.0, 0.0), (0.0, 1.0), (0.5, 1.0), (0.5, 1e-3), (1e9, 0.0), (700.0, 1.0)])
def test_attenuation(tau, cosine):
    exact = 1.0 if tau == 0 else math.exp(-min(tau / cosine, 1e5)) if cosine > 0 else 0.0
    assert _attenuation(tau, cosine) == pytest.approx(exact, rel=2e-13, abs=1e-303)
