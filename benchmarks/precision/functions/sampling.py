"""From random numbers to directions: visible normals and Lambert."""

import numpy as np

from goniosim._jit import kernel
from goniosim.optics.ggx import sample_visible_facet, sample_visible_normal
from goniosim.optics.lambert import sample_cosine

from .. import grids
from ..case import Case
from ..exact import ggx, lambert


@kernel
def _normal(p, out):
    for i in range(p.shape[1]):
        x, y, z, alpha, cosine, sine, u = p[0, i], p[1, i], p[2, i], p[3, i], p[4, i], p[5, i], p[6, i]
        out[0, i], out[1, i], out[2, i] = sample_visible_normal(x, y, z, alpha, cosine, sine, u)
        fx, _, fz = sample_visible_facet(x, y, z, alpha, cosine, sine, u)
        out[3, i] = fx / fz


@kernel
def _cosine(p, out):
    for i in range(p.shape[1]):
        out[0, i], out[1, i], out[2, i] = sample_cosine(p[0, i], p[1, i])


def uniform_numbers(dense):
    """0, and from 2^-52 to the last one below 1."""
    n, step = (27, 1) if dense else (5, 5)
    near = 1.0 - 10.0 ** -np.arange(1.0, 15.0, step)
    return np.unique(np.concatenate([[0.0], grids.logarithmic(2.0**-52, 0.5, n), near, [1.0 - 2.0**-52]]))


def _views(dense):
    turn = np.array([0.03, 0.2, 0.41, 0.77])[:: 1 if dense else 2]
    z = grids.cosines(dense)[:: 4 if dense else 2]
    alpha = grids.widths(dense)[:: 4 if dense else 1]
    z, alpha, azimuth, turn, u = grids.product(
        z, alpha, [0.0, 0.11], turn, uniform_numbers(dense)[:: 2 if dense else 1]
    )
    sine = np.sqrt((1.0 - z) * (1.0 + z))
    phi, angle = 2.0 * np.pi * azimuth, 2.0 * np.pi * turn
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), z, alpha, np.cos(angle), np.sin(angle), u])


def _numbers(dense):
    return grids.product(uniform_numbers(dense), uniform_numbers(dense))


def _component(which):
    return lambda *arguments: ggx.visible_normal(*arguments)[which]


def _slope(*arguments):
    x, _, z = ggx.visible_normal(*arguments)
    return x / z


def _lambert(which):
    return lambda u1, u2: lambert.cosine_direction(u1, u2)[which]


_VIEW = ("x", "y", "z", "alpha", "cosine", "sine", "u")
_GRID = "views of cos 1e-16 to 1, alpha 1e-6 to 1, u 0 to 1 - 2^-52"
_NUMBERS = "both numbers 0 and 2^-52 to 1 - 2^-52"

CASES = [
    Case("sample_visible_normal, x", _VIEW, _views, _GRID, _normal, _component(0), 0),
    Case("sample_visible_normal, y", _VIEW, _views, _GRID, _normal, _component(1), 1),
    Case("sample_visible_normal, z", _VIEW, _views, _GRID, _normal, _component(2), 2),
    Case("sample_visible_facet, slope x / z", _VIEW, _views, _GRID, _normal, _slope, 3),
    Case("sample_cosine, x", ("u1", "u2"), _numbers, _NUMBERS, _cosine, _lambert(0), 0),
    Case("sample_cosine, y", ("u1", "u2"), _numbers, _NUMBERS, _cosine, _lambert(1), 1),
    Case("sample_cosine, z", ("u1", "u2"), _numbers, _NUMBERS, _cosine, _lambert(2), 2),
]
