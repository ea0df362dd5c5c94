"""Points of cells: a random one, and what it becomes by turns about the cell's centre.

What is linear in the cell cancels. In lockstep over some neighbouring cells of a row.
"""

from ..._jit import stage
from ...optics.elementary import TWO_PI, sincos_turns
from ...slices import horizon_azimuth, view_direction, view_row
from ...slices.grid import HALF_PI


@stage
def columns_above(parametrization, row, rows, columns, width, light):
    """How many of a row's columns, from the first on, may reach above the horizon."""
    # The horizon comes nearer from row to row.
    azimuth = horizon_azimuth(parametrization, row * (HALF_PI / rows), light[0], light[2])
    # A row that is not folded ends above it, too.
    return min(width, int(azimuth * (columns / TWO_PI)) + 1) if 2 * width == columns else width


@stage
def find_points(quarters, parametrization, row, first, n, rows, columns, light, u, v, x, y, z, measure):
    """One point of each of ``n`` cells.

    Parameters
    ----------
    quarters : int
        By how many quarter turns it is ahead of the first, 0 to 3.
    parametrization, row, first : int
        Row, and column of the first cell.
    n, rows, columns : int
    light : ndarray, shape (3,)
    u, v : ndarray, shape (>= n,)
        Where the first points lie in their cells, in [0, 1): along the column and along the row.
    x, y, z, measure : ndarray, shape (>= n,)
        Overwritten: the direction, and cos(theta_v) d omega_v there, times the cell; the normal and 0 below the
        horizon.
    """
    height = HALF_PI / rows
    area = height * (TWO_PI / columns)
    # (u, v), (v, 1 - u), (1 - u, 1 - v), (1 - v, u)
    along = u if quarters % 2 == 0 else v
    across = v if quarters % 2 == 0 else u
    start, sign = (1.0, -1.0) if quarters >= 2 else (0.0, 1.0)
    _find_rows(parametrization, row + start, sign, along, n, height, x, z, measure)
    start, sign = (1.0, -1.0) if quarters == 1 or quarters == 2 else (0.0, 1.0)
    _find_columns(parametrization, first + start, sign, across, n, columns, light, area, x, y, z, measure)


@stage
def _find_rows(parametrization, start, sign, u, n, height, sines, cosines, jacobians):
    for i in range(n):
        sines[i], cosines[i], jacobians[i] = view_row(parametrization, (start + sign * u[i]) * height)


@stage
def _find_columns(parametrization, start, sign, v, n, columns, light, area, x, y, z, measure):
    """From what `_find_rows` left in ``x``, ``z`` and ``measure``."""
    lx = light[0]
    ly = light[1]
    lz = light[2]
    for i in range(n):
        sine, cosine = sincos_turns((start + i + sign * v[i]) / columns)
        vx, vy, vz, rest = view_direction(parametrization, x[i], z[i], cosine, sine, lx, ly, lz)
        above = (vz > 0.0) & (rest > 0.0)
        measure[i] = vz * measure[i] * rest * area if above else 0.0
        x[i] = vx if above else 0.0
        y[i] = vy if above else 0.0
        z[i] = vz if above else 1.0
