"""Classic slices: rows theta_v, columns phi_v, both linear."""

import math

from .._jit import kernel
from ..optics.elementary import arctan2_first_quadrant
from .grid import cell_number


@kernel
def cells_of(x, y, z, n, rows, columns, cell):
    """Cell numbers of ``n`` view vectors (minus x, minus y, z)."""
    for i in range(n):
        theta = arctan2_first_quadrant(math.sqrt(x[i] * x[i] + y[i] * y[i]), z[i])
        cell[i] = cell_number(theta, -x[i], -y[i], z[i], rows, columns)
