"""Nodes in polar angle and folded azimuth, with cubic Lagrange weights for what lies between them.

Node (j, i) stands at the azimuth j h and the polar angle i g: ``bins[j, i, channel]``. Stencils have 4 x 4 nodes,
one-sided at the pole and at grazing angles, mirrored at azimuths 0 and pi.
"""

import math

from ..._jit import scalar, stage
from ...optics.elementary import arctan2_first_quadrant, azimuth
from ...slices.grid import HALF_PI


@scalar
def cubic(u, lowest, highest):
    """First of the four nodes around ``u`` (in steps), and their weights; it lies in [lowest, highest]."""
    i = min(max(int(u) - 1, lowest), highest)
    t = u - i - 1
    a = t * (t - 1.0)
    b = (t + 1.0) * (t - 2.0)
    return i, a * (2.0 - t) / 6.0, b * (t - 1.0) * 0.5, -b * t * 0.5, a * (t + 1.0) / 6.0


@scalar
def place(x, y, z, to_horizon, half_turn):
    """Polar angle and folded azimuth of a direction, z >= 0, in nodes' distances: so many in 90 and in 180 degrees."""
    theta = arctan2_first_quadrant(math.sqrt(x * x + y * y), z)
    return theta * (to_horizon / HALF_PI), azimuth(abs(y), x) * (half_turn / math.pi)


@scalar
def mirrored(j, last):
    """Number in [0, last] of an azimuth's node that may lie beyond 0 or pi."""
    j = abs(j)
    return 2 * last - j if j > last else j


@stage
def stencils(x, y, z, ratios, n, to_horizon, half_turn, polar, around, first):
    """Find the nodes that ``n`` directions are spread over.

    Parameters
    ----------
    to_horizon, half_turn : int
        Distances of nodes in 90 degrees of polar angle, and in 180 of azimuth.
    polar, around : ndarray, shape (4, n)
        Overwritten: weights in polar angle; and in azimuth, times the ray's ratio.
    first : ndarray of int64, shape (2, n)
        Overwritten: the first node in polar angle, and in azimuth, which may lie beyond 0 or pi.
    """
    _place(x, y, z, n, to_horizon, half_turn, polar[0], around[0])
    _weigh_polar(n, to_horizon, first[0], polar[0], polar[1], polar[2], polar[3])
    _weigh_around(ratios, n, half_turn, first[1], around[0], around[1], around[2], around[3])


@stage
def _place(x, y, z, n, to_horizon, half_turn, u, v):
    for i in range(n):
        u[i], v[i] = place(x[i], y[i], z[i], to_horizon, half_turn)


@stage
def _weigh_polar(n, to_horizon, first, a0, a1, a2, a3):
    for i in range(n):
        first[i], a0[i], a1[i], a2[i], a3[i] = cubic(a0[i], 0, to_horizon - 3)


@stage
def _weigh_around(ratios, n, half_turn, first, b0, b1, b2, b3):
    for i in range(n):
        first[i], w0, w1, w2, w3 = cubic(b0[i], -1, half_turn - 1)
        b0[i] = w0 * ratios[i]
        b1[i] = w1 * ratios[i]
        b2[i] = w2 * ratios[i]
        b3[i] = w3 * ratios[i]
