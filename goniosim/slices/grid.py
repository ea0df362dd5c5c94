"""Coordinates to cell numbers, with the tie rule of `goniosim.slices`."""

import math

import numpy as np

from .._jit import scalar
from ..optics.elementary import TWO_PI, azimuth

# In cell widths; rounding of a walk stays orders of magnitude below, and no lobe resolves it.
SNAP = 1e-9
# Directions closer than this to the pole (as a tangent) have the azimuth 0.
POLE = 1e-10

HALF_PI = 0.5 * math.pi


@scalar
def cell_number(u, x, y, z, rows, columns):
    """Cell of row coordinate ``u`` in [0, pi/2] and of the azimuth of (x, y, z)."""
    row = min(np.int32(u * (rows / HALF_PI) + SNAP), rows - 1)
    at_pole = x * x + y * y < (POLE * POLE) * (z * z)
    phi = 0.0 if at_pole else azimuth(y, x)
    column = np.int32(phi * (columns / TWO_PI) + SNAP)
    column = 0 if column >= columns else column
    return row * columns + column
