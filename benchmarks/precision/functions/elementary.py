"""The polynomials that stand for the functions of libm."""

import mpmath
import numpy as np
from mpmath import mpf

from goniosim._jit import kernel
from goniosim.optics import elementary

from .. import grids
from ..case import Case


@kernel
def _turns(p, out):
    for i in range(p.shape[1]):
        out[0, i], out[1, i] = elementary.sincos_turns(p[0, i])


@kernel
def _octants(p, out):
    for i in range(p.shape[1]):
        out[0, i], out[1, i] = elementary.sincos_octants(p[0, i])


@kernel
def _quadrant(p, out):
    for i in range(p.shape[1]):
        out[0, i], out[1, i] = elementary.sincos_first_quadrant(p[0, i])


@kernel
def _exp(p, out):
    for i in range(p.shape[1]):
        out[0, i] = elementary.exp_nonpositive(p[0, i])


@kernel
def _arctan(p, out):
    for i in range(p.shape[1]):
        out[0, i] = elementary.arctan2_first_quadrant(p[0, i], p[1, i])
        out[1, i] = elementary.azimuth(p[0, i], p[1, i])
        out[2, i] = elementary.azimuth(p[0, i], -p[1, i])
        out[3, i] = elementary.azimuth(-p[0, i], p[1, i])


def _around(centres, dense):
    """Numbers on both sides of each, down to the last digit."""
    offsets = grids.logarithmic(1e-17, 0.125, 201 if dense else 33)
    return np.concatenate([c + sign * offsets for c in centres for sign in (-1.0, 1.0)] + [np.asarray(centres)])


def _turn_points(dense):
    u = np.append(_around([0.0, 0.25, 0.5, 0.75, 1.0], dense), np.linspace(0.0, 1.0, 4001 if dense else 101))
    return np.unique(u[(u >= 0.0) & (u <= 1.0)])[None]


def _octant_points(dense):
    t = np.append(_around([-0.5, 0.0, 0.5], dense), np.linspace(-0.5, 0.5, 4001 if dense else 101))
    return np.unique(t[np.abs(t) <= 0.5])[None]


def _angles(dense):
    x = np.append(
        _around([0.0, 0.25 * np.pi, 0.5 * np.pi], dense), np.linspace(0.0, 0.5 * np.pi, 4001 if dense else 101)
    )
    return np.unique(x[(x >= 0.0) & (x <= 0.5 * np.pi)])[None]


def _exponents(dense):
    x = np.concatenate([[0.0], grids.logarithmic(1e-20, 1e5, 4001 if dense else 201), [699.9, 700.0]])
    return -x[None]


def _plane(dense):
    tangent = np.concatenate([grids.logarithmic(1e-30, 1e30, 1201 if dense else 61), 1.0 + _around([0.0], dense)])
    tangent = np.append(tangent, np.tan(np.pi / 8 * (1.0 + _around([0.0], dense))))
    y, scale = grids.product(tangent, [1e-150, 1.0, 1e9])
    return np.stack([y * scale, scale])


def _azimuth(y_sign, x_sign):
    def exact(y, x):
        angle = mpmath.atan2(y_sign * y, x_sign * x)
        return angle if angle >= 0 else angle + 2 * mpmath.pi

    return exact


_POINT = ("y", "x")
_TURNS = "u 0 to 1, 1e-17 from whole quarters and away"
_OCTANTS = "t -1/2 to 1/2, 1e-17 from 0 and away"
_ANGLES = "x 0 to pi/2, 1e-17 from 0, pi/4 and pi/2 and away"
_PLANE = "y / x 1e-30 to 1e30, at x 1e-150, 1 and 1e9"

CASES = [
    Case("sincos_turns, sine", ("u",), _turn_points, _TURNS, _turns, lambda u: mpmath.sinpi(2 * u), 0),
    Case("sincos_turns, cosine", ("u",), _turn_points, _TURNS, _turns, lambda u: mpmath.cospi(2 * u), 1),
    Case("sincos_octants, sine", ("t",), _octant_points, _OCTANTS, _octants, lambda t: mpmath.sinpi(t / 2), 0),
    Case("sincos_octants, cosine", ("t",), _octant_points, _OCTANTS, _octants, lambda t: mpmath.cospi(t / 2), 1),
    Case("sincos_first_quadrant, sine", ("x",), _angles, _ANGLES, _quadrant, mpmath.sin, 0),
    Case(
        "sincos_first_quadrant, cosine",
        ("x",),
        _angles,
        _ANGLES,
        _quadrant,
        mpmath.cos,
        1,
        "next to pi/2, for which the nearest float stands",
    ),
    Case(
        "exp_nonpositive",
        ("x",),
        _exponents,
        "x 0 and -1e-20 to -1e5; below -700 it is 0",
        _exp,
        lambda x: mpmath.exp(x) if x > mpf(-710) else mpf(0),
        floor=float(np.exp(-700.0) * (1.0 - 1e-12)),
    ),
    Case("arctan2_first_quadrant", _POINT, _plane, _PLANE, _arctan, mpmath.atan2, 0),
    Case("azimuth, first quadrant", _POINT, _plane, _PLANE, _arctan, _azimuth(1, 1), 1),
    Case("azimuth, second quadrant", _POINT, _plane, _PLANE, _arctan, _azimuth(1, -1), 2),
    Case("azimuth, fourth quadrant", _POINT, _plane, _PLANE, _arctan, _azimuth(-1, 1), 3),
]
