"""The vectorisable elementary functions against libm."""

import math

import numpy as np
import pytest

from goniosim._jit import kernel
from goniosim.optics import elementary


@kernel
def _sincos(u, sine, cosine):
    for i in range(u.shape[0]):
        sine[i], cosine[i] = elementary.sincos_turns(u[i])


@kernel
def _sincos_of_angles(x, sine, cosine):
    for i in range(x.shape[0]):
        sine[i], cosine[i] = elementary.sincos_first_quadrant(x[i])


@kernel
def _exp(x, y):
    for i in range(x.shape[0]):
        y[i] = elementary.exp_nonpositive(x[i])


@kernel
def _azimuth(y, x, phi):
    for i in range(x.shape[0]):
        phi[i] = elementary.azimuth(y[i], x[i])


def test_sincos_of_turns():
    u = np.concatenate([np.linspace(0.0, 1.0, 100_001), np.arange(9) / 8, [0.25 - 2**-54, 1 - 2**-53]])
    sine, cosine = np.empty_like(u), np.empty_like(u)
    _sincos(u, sine, cosine)
    # sin(2 pi u) itself is rounded at its argument: compare with the reduction done by symmetry.
    quadrant = np.rint(4 * u)
    x = (u - quadrant / 4) * 2 * math.pi
    table = np.array([np.sin(x), np.cos(x), -np.sin(x), -np.cos(x)])
    index = quadrant.astype(int) % 4
    exact_sine = table[index, np.arange(len(u))]
    exact_cosine = table[(index + 1) % 4, np.arange(len(u))]
    # The first term left out of the cosine is (pi/4)^16 / 16! = 1.0e-15; rounding adds to it.
    assert np.abs(sine - exact_sine).max() < 1.5e-15
    assert np.abs(cosine - exact_cosine).max() < 1.5e-15


def test_sincos_of_angles():
    x = np.concatenate([np.linspace(0.0, math.pi / 2, 100_001), np.logspace(-20, -1, 50), [math.pi / 4]])
    sine, cosine = np.empty_like(x), np.empty_like(x)
    _sincos_of_angles(x, sine, cosine)
    assert np.abs(sine - np.sin(x)).max() < 1.5e-15
    assert np.abs(cosine - np.cos(x)).max() < 1.5e-15
    small = (x > 0.0) & (x < 0.1)
    assert np.abs(sine[small] / np.sin(x[small]) - 1.0).max() < 1e-15


def test_azimuth_uses_all_directions_near_the_axes():
    # A shorter series for the cosine, sqrt(1 - sin^2), once moved azimuths near 90 degrees by 1e-5.
    u = 0.25 + np.logspace(-12, -3, 50)
    sine, cosine = np.empty_like(u), np.empty_like(u)
    _sincos(u, sine, cosine)
    assert np.allclose(cosine, -np.sin(2 * math.pi * (u - 0.25)), rtol=1e-12, atol=0)


def test_exp_of_nonpositive():
    x = -np.concatenate([[0.0], np.logspace(-20, np.log10(699.0), 100_000)])
    y = np.empty_like(x)
    _exp(x, y)
    assert np.abs(y / np.exp(x) - 1).max() < 2e-13  # rounding of k ln 2 at -700; 1e-15 above -1
    near = x > -1
    assert np.abs(y[near] / np.exp(x[near]) - 1).max() < 2e-15


@pytest.mark.parametrize("x", [-700.0001, -1e4, -1e300, -np.inf])
def test_exp_far_below_is_zero(x):
    y = np.empty(1)
    _exp(np.array([x]), y)
    assert y[0] == 0.0


def test_azimuth():
    phi = np.linspace(0.0, 2 * math.pi, 200_001)[:-1]
    radius = np.resize([1e-200, 1e-9, 1.0, 1e9], phi.shape)
    y, x = radius * np.sin(phi), radius * np.cos(phi)
    found = np.empty_like(phi)
    _azimuth(y, x, found)
    exact = np.arctan2(y, x) % (2 * math.pi)
    difference = np.abs(found - exact)
    assert np.minimum(difference, 2 * math.pi - difference).max() < 2e-15
    assert found.min() >= 0.0 and found.max() <= 2 * math.pi


def test_azimuth_of_the_origin_is_zero():
    found = np.empty(1)
    _azimuth(np.zeros(1), np.zeros(1), found)
    assert found[0] == 0.0
