"""Where half slices end, and their Jacobian."""

import mpmath
import numpy as np
from mpmath import mpf

from goniosim._jit import kernel
from goniosim.slices import half

from .. import grids
from ..case import Case


@kernel
def _row(p, out):
    for i in range(p.shape[1]):
        out[0, i], out[1, i], out[2, i] = half.view_row(p[0, i])


@kernel
def _azimuth(p, out):
    for i in range(p.shape[1]):
        out[0, i] = half.horizon_azimuth(p[0, i], p[1, i], p[2, i])


@kernel
def _coordinate(p, out):
    for i in range(p.shape[1]):
        out[0, i] = half.horizon_coordinate(p[0, i], p[1, i], p[2, i])


def _rows(dense):
    u = np.append(grids.logarithmic(1e-12, 0.5 * np.pi, 801 if dense else 101), np.linspace(0.0, 1.5, 151))
    return np.unique(u)[None]


def _lights(dense):
    theta = np.concatenate([[0.0], grids.logarithmic(1e-12, 1.5, 13 if dense else 4), np.radians([60.0, 89.0, 89.999])])
    return theta


def _edges(dense):
    u, theta = grids.product(np.linspace(0.0, 0.5 * np.pi, 91)[:: 1 if dense else 9], _lights(dense))
    return np.stack([u, np.sin(theta), np.cos(theta)])


def _azimuths(dense):
    phi, theta = grids.product(np.radians(np.arange(0.0, 181.0, 1.0 if dense else 15.0)), _lights(dense))
    return np.stack([phi, np.sin(theta), np.cos(theta)])


def _tilt(u):
    return 2 * u**2 / mpmath.pi


def _jacobian(u):
    return 16 * u / mpmath.pi * mpmath.sin(_tilt(u))


def _horizon_azimuth(u, lx, lz):
    """Phi at which l_x sin(2 t) cos(phi) + l_z cos(2 t) = 0."""
    a, b = lx * mpmath.sin(2 * _tilt(u)), lz * mpmath.cos(2 * _tilt(u))
    if a <= abs(b):
        return mpmath.pi + 0 if b > 0 else mpf(0)
    return mpmath.acos(-b / a)


def _horizon_coordinate(phi, lx, lz):
    return mpmath.sqrt(mpmath.pi / 4 * mpmath.atan2(lz, -lx * mpmath.cos(phi)))


_ROWS = "u 0 and 1e-12 to pi/2"

CASES = [
    Case("half view_row, sine", ("u",), _rows, _ROWS, _row, lambda u: mpmath.sin(_tilt(u)), 0),
    Case(
        "half view_row, cosine",
        ("u",),
        _rows,
        _ROWS,
        _row,
        lambda u: mpmath.cos(_tilt(u)),
        1,
        "at pi/2, for which the nearest float stands",
    ),
    Case("half view_row, Jacobian", ("u",), _rows, _ROWS, _row, _jacobian, 2),
    Case(
        "half horizon_azimuth",
        ("u", "l_x", "l_z"),
        _edges,
        "edges of 90 rows, light at 0 and 1e-12 rad to 89.999 degrees",
        _azimuth,
        _horizon_azimuth,
    ),
    Case(
        "half horizon_coordinate",
        ("phi", "l_x", "l_z"),
        _azimuths,
        "phi 0 to 180 degrees, light at 0 and 1e-12 rad to 89.999 degrees",
        _coordinate,
        _horizon_coordinate,
    ),
]
