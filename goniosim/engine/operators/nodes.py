"""Nodes in polar angle and folded azimuth, with cubic Lagrange weights for what lies between them.

Node (j, i) stands at the azimuth j h and the polar angle i h: ``bins[j, i, channel]``. Stencils have 4 x 4 nodes,
one-sided at the pole and at grazing angles, mirrored at azimuths 0 and pi. With a ``stride`` of 2 they use every second
node.
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
def place(x, y, z, nodes, stride):
    """Polar angle and folded azimuth of the direction (x, y, z), z >= 0, in steps of ``stride`` nodes of n + 1."""
    per_radian = (nodes // stride) / HALF_PI
    theta = arctan2_first_quadrant(math.sqrt(x * x + y * y), z)
    return theta * per_radian, azimuth(abs(y), x) * per_radian


@scalar
def mirrored(j, last):
    """Number in [0, last] of an azimuth's node that may lie beyond 0 or pi."""
    j = abs(j)
    return 2 * last - j if j > last else j


@stage
def deposit(x, y, z, weights, ratio, stride, bins):
    """Spread ``weights[channel] * ratio`` over the nodes around a direction."""
    nodes = bins.shape[1] - 1
    u, v = place(x, y, z, nodes, stride)
    i, a0, a1, a2, a3 = cubic(u, 0, nodes // stride - 3)
    last = 2 * (nodes // stride)
    j, b0, b1, b2, b3 = cubic(v, -1, last - 1)
    for s in range(4):
        b = ratio * (b0 if s == 0 else (b1 if s == 1 else (b2 if s == 2 else b3)))
        row = bins[mirrored(j + s, last) * stride]
        for r in range(4):
            a = b * (a0 if r == 0 else (a1 if r == 1 else (a2 if r == 2 else a3)))
            node = row[(i + r) * stride]
            for c in range(weights.shape[0]):
                node[c] += a * weights[c]
