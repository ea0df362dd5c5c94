"""Fresnel: reflectances, what they leave, and the coin."""

import numpy as np

from goniosim._jit import kernel
from goniosim.optics.elementary import bits_to_float, float_to_bits
from goniosim.optics.fresnel import (
    conductor_absorptance,
    dielectric_transmittance,
    fresnel_conductor,
    fresnel_dielectric,
    reflects,
    scaled_transmittance,
)

from .. import grids
from ..case import Case
from ..exact import fresnel as exact

# Lengths of the normals of the scaled forms.
_LENGTHS = (1.0, 0.7, 1e-9)
# Less than the least reflectance or absorptance on the grid: what the oracles find instead of 0.
_NONE = 1e-40
_SHORTEST = np.uint64(1)


@kernel
def _dielectric(p, out):
    for i in range(p.shape[1]):
        out[0, i], out[1, i] = fresnel_dielectric(p[0, i], p[1, i])
        out[2, i] = dielectric_transmittance(p[0, i], p[1, i])


@kernel
def _scaled(p, out):
    for i in range(p.shape[1]):
        out[0, i], out[1, i] = scaled_transmittance(p[0, i], p[1, i], p[2, i])


@kernel
def _coin(p, out):
    """The number at which the coin turns, found by halving the bits of floats from 0 to 2."""
    for i in range(p.shape[1]):
        c, square, eta = p[0, i], p[1, i], p[2, i]
        low, high = np.uint64(0), float_to_bits(2.0)
        while high - low > _SHORTEST:
            middle = (low + high) >> _SHORTEST
            heads, _ = reflects(bits_to_float(middle), c, square, eta)
            low = middle if heads else low
            high = high if heads else middle
        out[0, i] = bits_to_float(low)
        _, out[1, i] = reflects(0.5, c, square, eta)


@kernel
def _conductor(p, out):
    for i in range(p.shape[1]):
        out[0, i] = fresnel_conductor(p[0, i], p[1, i], p[2, i])
        out[1, i] = conductor_absorptance(p[0, i], p[1, i], p[2, i])


def _scaled_points(dense):
    cosine, eta = grids.fresnel(dense)
    parts = [np.stack([cosine * s, np.full_like(cosine, s * s), eta]) for s in _LENGTHS]
    points = np.concatenate(parts, axis=1)
    # No product of a view and a normal is longer than the normal.
    return points[:, points[0] ** 2 <= points[1]]


def _open_points(dense):
    """Those at which some light gets through: beyond, the coin has no number at which it turns."""
    c, square, eta = _scaled_points(dense)
    through = c * c / square > (1.0 - eta) * (1.0 + eta) + 1e-15
    return np.stack([c, square, eta])[:, through & (eta != 1.0)]


def _conductor_points(dense):
    """All combinations, and little absorption next to critical angles."""
    wide = grids.product(
        grids.cosines(dense)[:: 3 if dense else 1], grids.indices(dense)[::3], grids.absorptions(dense)[::2]
    )
    pairs = grids.critical(dense)[:, :: 3 if dense else 1]
    kappa = np.array([0.0, 1e-12, 1e-9, 1e-5])[:: 1 if dense else 2]
    near = np.concatenate([np.stack([*pairs, np.full(pairs.shape[1], k)]) for k in kappa], axis=1)
    return np.concatenate([wide, near], axis=1)


def _at_facet(f):
    return lambda c, square, eta: f(exact.facet_cosine(c, square), eta)


_C, _ETA, _KAPPA, _SQUARE = "cos_i", "eta", "kappa", "square"
_GRID = "cos 1e-16 to 1 and 1 - 10^-k, eta .05 to 10 and 1 ± 10^-k, critical angles ± 10^-k"
_SCALED = _GRID + ", normals of length 1, .7 and 1e-9"
_METAL = "cos 1e-16 to 1, eta .05 to 10 and 1 ± 10^-k, kappa 0 and 1e-12 to 1e6"
_CRITICAL = "next to the critical angle"

CASES = [
    Case(
        "fresnel_dielectric, R",
        (_C, _ETA),
        grids.fresnel,
        _GRID,
        _dielectric,
        exact.dielectric_reflectance,
        floor=_NONE,
    ),
    Case("fresnel_dielectric, cos_t", (_C, _ETA), grids.fresnel, _GRID, _dielectric, exact.cos_t, 1),
    Case("dielectric_transmittance", (_C, _ETA), grids.fresnel, _GRID, _dielectric, exact.dielectric_transmittance, 2),
    Case(
        "scaled_transmittance, 1 - R",
        (_C, _SQUARE, _ETA),
        _scaled_points,
        _SCALED,
        _scaled,
        _at_facet(exact.dielectric_transmittance),
        0,
        _CRITICAL,
    ),
    Case(
        "scaled_transmittance, g", (_C, _SQUARE, _ETA), _scaled_points, _SCALED, _scaled, exact.scaled_g, 1, _CRITICAL
    ),
    Case(
        "reflects, where the coin turns",
        (_C, _SQUARE, _ETA),
        _open_points,
        _SCALED,
        _coin,
        _at_facet(exact.dielectric_reflectance),
        0,
        _CRITICAL,
    ),
    Case("reflects, g", (_C, _SQUARE, _ETA), _open_points, _SCALED, _coin, exact.scaled_g, 1, _CRITICAL),
    Case(
        "fresnel_conductor",
        (_C, _ETA, _KAPPA),
        _conductor_points,
        _METAL,
        _conductor,
        exact.conductor_reflectance,
        floor=_NONE,
    ),
    Case(
        "conductor_absorptance",
        (_C, _ETA, _KAPPA),
        _conductor_points,
        _METAL,
        _conductor,
        exact.conductor_absorptance,
        1,
        floor=_NONE,
    ),
]
