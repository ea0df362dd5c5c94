"""Fresnel and Snell where digits are easily lost: near an index of 1, at grazing incidence, in good mirrors.

Every function against the same formula in decimal arithmetic of 80 digits.
"""

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest

from goniosim._jit import kernel
from goniosim.optics.fresnel import (
    conductor_absorptance,
    dielectric_transmittance,
    fresnel_conductor,
    fresnel_dielectric,
    reflects,
)
from goniosim.optics.refraction import refracted_cosine, refraction_shift
from reference import exact_fresnel

NEAR_ONE = [1.0, *(1.0 + s * 10.0**-e for e in range(1, 13) for s in (1.0, -1.0))]
ETAS = [*NEAR_ONE, 0.1, 0.2, 0.5, 1.0 / 1.5, 0.75, 1.2, 1.33, 1.5, 2.0, 4.0, 10.0]
THETAS = [*range(90), *(90.0 - 10.0**-e for e in range(1, 8))]
COSINES = np.cos(np.radians(THETAS))


@kernel
def _dielectric(cosines, eta, found):
    for i in range(cosines.shape[0]):
        found[0, i], found[2, i] = fresnel_dielectric(cosines[i], eta)
        found[1, i] = dielectric_transmittance(cosines[i], eta)


@kernel
def _reflects(u, cosines, length, eta, coin, found):
    for i in range(cosines.shape[0]):
        coin[i], g = reflects(u[i], length * cosines[i], length * length, eta)
        found[i] = g / (length * eta)


@kernel
def _conductor(cosines, eta, kappa, found):
    for i in range(cosines.shape[0]):
        found[0, i] = fresnel_conductor(cosines[i], eta, kappa)
        found[1, i] = conductor_absorptance(cosines[i], eta, kappa)


@kernel
def _refracted(cosines, ratio, found):
    for i in range(cosines.shape[0]):
        found[0, i] = refracted_cosine(cosines[i], ratio)
        found[1, i] = refraction_shift(cosines[i], ratio, found[0, i])


def error(found, exact):
    """Relative error, and absolute where nothing is expected but the rounding of 80 digits."""
    return abs(Decimal(found) - exact) / (abs(exact) if abs(exact) > Decimal("1e-30") else 1)


@pytest.mark.parametrize("eta", ETAS)
def test_dielectric(eta):
    """Reflectance and cosine to 1e-13, the transmittance even relatively; the critical angle included."""
    critical = math.cos(math.asin(min(eta, 1.0)))
    cosines = np.append(COSINES, [critical, np.nextafter(critical, 1.0), np.nextafter(critical, 0.0)])
    found = np.empty((3, len(cosines)))
    _dielectric(cosines, eta, found)
    assert (found >= 0.0).all() and (found[:2] <= 1.0).all() and (found[2] <= 1.0 + 1e-15).all()
    for i, cosine in enumerate(cosines):
        reflectance, transmittance, cos_t = exact_fresnel.dielectric(cosine, eta)
        assert abs(Decimal(found[0, i]) - reflectance) < 1e-13
        assert error(found[1, i], transmittance) < 1e-13
        assert abs(Decimal(found[2, i]) - cos_t) < 1e-13


@pytest.mark.parametrize("length", [1.0, 0.7, 1e-9])
@pytest.mark.parametrize("eta", ETAS)
def test_the_coin_falls_with_the_reflectance_for_normals_of_any_length(eta, length):
    """Heads just below the reflectance and tails just above it; the cosine of the refracted ray to 1e-13 beside."""
    cosines = COSINES if eta >= 1.0 else COSINES[math.cos(math.asin(eta)) + 1e-9 < COSINES]
    exact = np.empty((3, len(cosines)))
    _dielectric(cosines, eta, exact)
    coin, cos_t = np.empty(len(cosines), bool), np.empty(len(cosines))
    _reflects(exact[0] - 1e-13, cosines, length, eta, coin, cos_t)
    assert coin[exact[0] > 1e-13].all()
    _reflects(exact[0] + 1e-13, cosines, length, eta, coin, cos_t)
    assert not coin.any()
    assert np.abs(cos_t**2 - exact[2] ** 2).max() < 1e-13 * max(1.0, 1.0 / eta**2)


def test_the_coin_always_reflects_where_no_light_gets_through():
    cosines = np.array([0.0, 0.1, 0.7])
    coin, cos_t = np.empty(3, bool), np.empty(3)
    _reflects(np.full(3, 1.0 - 2.0**-52), cosines, 0.5, 1.0 / 1.5, coin, cos_t)
    assert coin.all() and (cos_t == 0.0).all()


@pytest.mark.parametrize("kappa", [0.0, 1e-9, 1e-7, 1e-5, 1e-3, 0.01, 0.3, 1.0, 10.0, 1e3, 1e5, 1e6])
@pytest.mark.parametrize("eta", [*NEAR_ONE[::3], 1e-3, 0.05, 0.5, 1.2 / 1.5, 1.45, 3.0, 100.0, 1e3])
def test_conductor(eta, kappa):
    """Reflectance and absorptance to a relative 1e-12, from normal incidence to a cosine of 1e-6."""
    cosines = np.concatenate([np.logspace(-6, 0, 25), COSINES[:90:5]])
    found = np.empty((2, len(cosines)))
    _conductor(cosines, eta, kappa, found)
    assert (found >= 0.0).all() and (found <= 1.0).all()
    for i, cosine in enumerate(cosines):
        for value, exact in zip(found[:, i], exact_fresnel.conductor(cosine, eta, kappa), strict=True):
            assert error(value, exact) < 1e-12


@pytest.mark.parametrize("ratio", [ratio for ratio in ETAS if ratio <= 1.0 or ratio - 1.0 < 1e-9])
def test_refraction(ratio):
    """Both keep their digits up to grazing incidence; the critical angle and what lies beyond are left out."""
    found = np.empty((2, len(COSINES)))
    _refracted(COSINES, ratio, found)
    for i, cosine in enumerate(COSINES):
        with localcontext(prec=80):
            c, r = Decimal(cosine), Decimal(ratio)
            square = 1 - r * r * (1 - c * c)
            if square > Decimal("1e-6") * c * c:
                assert error(found[0, i], square.sqrt()) < 1e-9
                assert error(found[1, i], square.sqrt() - r * c) < 1e-9


def test_equal_indices_reflect_nothing_at_any_angle():
    cosines = np.append(COSINES, [1e-15, 1e-200, 0.0])
    found = np.empty((3, len(cosines)))
    _dielectric(cosines, 1.0, found)
    assert not found[0].any()
    assert found[1] == pytest.approx(1.0, abs=1e-15)
    assert found[2, :-2] == pytest.approx(cosines[:-2], rel=1e-15)


def test_parallel_light_is_reflected_unless_the_indices_are_equal():
    found = np.empty((3, 1))
    for eta in (0.5, 1.0 - 1e-12, 1.0 + 1e-12, 1.5):
        _dielectric(np.zeros(1), eta, found)
        assert found[0, 0] == pytest.approx(1.0, rel=1e-15)
    found = np.empty((2, 1))
    for eta, kappa, reflectance in ((1.0, 0.0, 0.0), (1.0, 1e-9, 1.0), (0.2, 3.4, 1.0)):
        _conductor(np.zeros(1), eta, kappa, found)
        assert found[:, 0] == pytest.approx([reflectance, 1.0 - reflectance], abs=1e-15)
