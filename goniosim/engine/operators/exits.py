"""Directions followed backwards through a narrow exit, by facets as seen from outside; in lockstep.

The rare tail of the facets is drawn apart, as a difference to the core at the same point: the weights of tail and core
are constants, and do not add to the scatter.
"""

from ..._jit import stage
from ...optics.elementary import sincos_turns
from ...optics.fresnel import fresnel_dielectric
from ...optics.ggx import sample_visible_normal, smith_g1
from ..lattice import coordinate

# Facets of the tail, of each cell.
TAILS = 2
# Share of the facets that is the tail, and how its points are drawn: 1 - u = TAIL t^3, of weight 3 t^2.
TAIL = 0.02
_LEAST_TAIL = 1e-12
_LEAST_COSINE = 1e-9


@stage
def core_heights(n, heights):
    """Turn uniform numbers into heights of facets of the core."""
    for i in range(n):
        heights[i] *= 1.0 - TAIL


@stage
def tail_heights(u, number, n, heights, shares):
    """Heights of facets of the tail, the ``number``-th of each cell, and what share of all facets each stands for."""
    for i in range(n):
        t = coordinate(u[i], number, 1.0 / TAILS)
        heights[i] = 1.0 - max(TAIL * t * t * t, _LEAST_TAIL)
        shares[i] = 3.0 * (TAIL / TAILS) * t * t


@stage
def follow(x, y, z, azimuths, turn, heights, n, alpha, eta, bx, by, bz, gain):
    """Follow ``n`` directions through a facet each.

    Parameters
    ----------
    x, y, z : ndarray, shape (>= n,)
        Unit vectors outside.
    azimuths, heights : ndarray, shape (>= n,)
        What facets are drawn from, in [0, 1).
    turn : float
        Added to the azimuths, in turns.
    n : int
    alpha, eta : float
        Width of the exit, and its index inside over outside.
    bx, by, bz : ndarray, shape (>= n,)
        Overwritten: unit vectors inside.
    gain : ndarray, shape (>= n,)
        Multiplied by what of the radiance inside is seen outside.
    """
    _find_facets(x, y, z, azimuths, turn, heights, n, alpha, bx, by, bz)
    _refract(x, y, z, n, alpha, eta, bx, by, bz, gain)


@stage
def _find_facets(x, y, z, azimuths, turn, heights, n, alpha, mx, my, mz):
    for i in range(n):
        sine, cosine = sincos_turns(coordinate(azimuths[i], 1, turn))
        mx[i], my[i], mz[i] = sample_visible_normal(x[i], y[i], z[i], alpha, cosine, sine, heights[i])


@stage
def _refract(x, y, z, n, alpha, eta, bx, by, bz, gain):
    """By the normals in ``bx``, ``by`` and ``bz``."""
    for i in range(n):
        cosine = min(1.0, max(0.0, x[i] * bx[i] + y[i] * by[i] + z[i] * bz[i]))
        reflectance, cos_t = fresnel_dielectric(cosine, eta)
        along = cosine / eta - cos_t
        bx[i] = x[i] / eta - along * bx[i]
        by[i] = y[i] / eta - along * by[i]
        height = z[i] / eta - along * bz[i]
        gain[i] *= (1.0 - reflectance) * smith_g1(height, alpha) / (eta * eta)
        bz[i] = max(height, _LEAST_COSINE)
