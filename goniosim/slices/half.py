"""Half slices: rows u = sqrt(theta_h pi / 2), columns phi_h, with h = normalize(l + v)."""

import math

from .._jit import kernel
from ..optics.elementary import arctan2_first_quadrant
from .grid import HALF_PI, cell_number


@kernel
def cells_of(x, y, z, n, rows, columns, light, cell):
    """Cell numbers of ``n`` view vectors (minus x, minus y, z), seen from ``light``."""
    lx = light[0]
    ly = light[1]
    lz = light[2]
    for i in range(n):
        hx = lx - x[i]
        hy = ly - y[i]
        hz = lz + z[i]
        theta_h = arctan2_first_quadrant(math.sqrt(hx * hx + hy * hy), hz)
        cell[i] = cell_number(math.sqrt(theta_h * HALF_PI), hx, hy, hz, rows, columns)
