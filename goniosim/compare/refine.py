"""How far n x n sub-cells are from converged, and integration to convergence where they are not.

Only some cells can be wrong: those in which the values at the sub-cells differ much, their
neighbours (a narrow lobe may stand between the sub-cells of one cell and show in the next), and
those around the mirror direction. In all others the error of the midpoint rule is of the order
of spread^2 / (24 n^2), below 1e-3.
"""

import math

import numpy as np

from ..cores import available_cores
from ..optics.elementary import TWO_PI
from ..slices import PARAMETRIZATIONS
from ..slices.grid import HALF_PI
from .integrate import BLOCK, integrate
from .kernels import fill_rectangles, sum_cells

# Cells with a larger spread of the values at their sub-cells are suspicious.
SPREAD = 0.25
# Error of a refined slice, relative to the root of the integral of f^2 cos(theta_v).
TOLERANCE = 1e-3
MAX_LEVELS = 24

_x, _w = np.polynomial.legendre.leggauss(3)
_NODES = 0.5 * (1.0 + _x)
_WEIGHTS = 0.5 * _w


def finer(prepared, grid, n, pool, energy, spread):
    """Energies with n x n sub-cells in every cell where a finer division can matter.

    Parameters
    ----------
    prepared, grid, n, pool
        As in `integrate`; ``n`` is the finer division.
    energy, spread : ndarray
        What `integrate` returned for the coarser one.

    Returns
    -------
    energy : ndarray, shape (distinct channels, cells)
    suspects : ndarray of int
        Places in ``grid.numbers`` of the cells that were integrated again.
    """
    suspects = _suspects(prepared, grid, spread)
    better = energy.copy()
    better[:, suspects] = integrate(prepared, grid, n, pool, grid.numbers[suspects])[0]
    return better, suspects


def refine(prepared, grid, narrowest, pool, energy, suspects):
    """Energies integrated adaptively in the suspicious cells.

    Each cell is cut into four until the Gauss-Legendre rules of the parts agree with that of the
    whole, and around the mirror direction first down to the width of the narrowest lobe,
    which could be missed otherwise.

    Parameters
    ----------
    prepared, grid, pool
        As in `integrate`.
    narrowest : float
        GGX width of the narrowest rough interface.
    energy : ndarray, shape (distinct channels, cells)
        From `finer`; kept where nothing is suspicious.
    suspects : ndarray of int
        From `finer`.

    Returns
    -------
    ndarray, shape (distinct channels, cells)
    """
    module = PARAMETRIZATIONS[grid.parametrization][1]
    peak = _coordinates(grid, _mirror(prepared))
    # The azimuth matters everywhere, on the scale of a radian.
    scales = np.minimum(0.25 * np.array(module.lobe_scales(narrowest, math.radians(grid.theta_deg))), 0.5)
    size = grid.projected_solid_angle[:, : grid.half_columns].ravel()[grid.numbers]
    # Each cell may spend its share of the error; a difference of two rules overstates it.
    budget = TOLERANCE**2 * (energy**2 / size).sum(axis=1).max() / len(energy[0])

    d_u, d_phi = HALF_PI / grid.rows, TWO_PI / grid.columns
    cell = suspects
    row, column = np.divmod(grid.numbers[suspects], grid.half_columns)
    todo = np.stack([row * d_u, column * d_phi, np.full(len(row), d_u), np.full(len(row), d_phi)], axis=1)
    whole = _rule(prepared, grid, todo, pool)
    better = energy.copy()
    better[:, suspects] = 0.0
    for level in range(MAX_LEVELS):
        parts = _quarter(todo)
        values = _rule(prepared, grid, parts, pool)
        sums = values.reshape(len(values), -1, 4).sum(axis=2)
        error = np.abs(sums - whole).max(axis=0)
        settled = error**2 <= budget * size[cell]
        settled &= ~_holds_peak(todo, peak, scales)
        settled |= level == MAX_LEVELS - 1
        for total, value in zip(better, sums, strict=True):
            np.add.at(total, cell[settled], value[settled])
        if settled.all():
            break
        again = np.repeat(~settled, 4)
        todo, whole, cell = parts[again], values[:, again], np.repeat(cell[~settled], 4)
    return better


def _suspects(prepared, grid, spread):
    marked = np.zeros(grid.rows * grid.half_columns, bool)
    marked[grid.numbers] = spread > SPREAD
    slices = grid.unfold(marked).copy()
    row, column = grid.cell_of(_mirror(prepared))
    slices[row, column] = True
    if row == 0:
        slices[0] = True
    rows, columns = np.nonzero(slices)
    grown = np.zeros_like(slices)
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            grown[np.clip(rows + i, 0, grid.rows - 1), (columns + j) % grid.columns] = True
    return np.flatnonzero(grown[:, : grid.half_columns].ravel()[grid.numbers])


def _mirror(prepared):
    lx, ly, lz = prepared.light
    return np.array([-lx, -ly, lz])


def _coordinates(grid, direction):
    """Row coordinate and azimuth of a view direction, in radians."""
    axis = direction
    if grid.parametrization == "half":
        axis = direction + grid.light
    tilt = math.atan2(math.hypot(axis[0], axis[1]), axis[2])
    u = math.sqrt(tilt * HALF_PI) if grid.parametrization == "half" else tilt
    return u, math.atan2(axis[1], axis[0]) % TWO_PI


def _holds_peak(rectangles, peak, scales):
    """Which rectangles lie at the peak of the lobes and are larger than ``scales`` in u or in phi."""
    u, phi, d_u, d_phi = rectangles.T
    peak_u, peak_phi = peak
    near = np.abs(u + 0.5 * d_u - peak_u) <= d_u
    # At the pole of the slice the peak lies at every azimuth.
    around = (np.abs(phi + 0.5 * d_phi - peak_phi) <= d_phi) | (peak_u <= d_u)
    return near & around & ((d_u > scales[0]) | (d_phi > scales[1]))


def _quarter(rectangles):
    """Four parts of each rectangle, one after the other."""
    u, phi, d_u, d_phi = np.repeat(rectangles, 4, axis=0).T
    # Next to the pole of the slice a rectangle is a thin wedge: cut its length only.
    wedge = (u + d_u) * d_phi < 0.5 * d_u
    i, j = np.tile([[0, 0, 1, 1], [0, 1, 0, 1]], len(rectangles))
    i = np.where(wedge, 2 * i + j, i)
    j = np.where(wedge, 0, j)
    d_u = np.where(wedge, 0.25, 0.5) * d_u
    d_phi = np.where(wedge, 1.0, 0.5) * d_phi
    return np.stack([u + i * d_u, phi + j * d_phi, d_u, d_phi], axis=1)


def _rule(prepared, grid, rectangles, pool):
    """Integrals over rectangles by a Gauss-Legendre rule, shape (distinct channels, rectangles)."""
    per_cell = len(_NODES) ** 2
    energy = np.empty((len(prepared.mirror_energy), len(rectangles)))
    step = BLOCK // per_cell
    starts = range(0, len(rectangles), step)
    light = grid.light

    def work(own_starts):
        for start in own_starts:
            part = rectangles[start : start + step]
            x, y, z, weight = np.empty((4, len(part) * per_cell))
            values = np.empty((len(energy), len(x)))
            fill_rectangles(grid.code, light, part, _NODES, _WEIGHTS, x, y, z, weight)
            prepared.kernel(prepared.tables, prepared.light, x, y, z, values)
            sums = np.empty((len(energy), len(part)))
            sum_cells(values, weight, per_cell, sums, np.empty(len(part)))
            energy[:, start : start + step] = sums

    workers = available_cores()
    for _ in pool.map(work, [starts[w::workers] for w in range(workers)]):
        pass
    return energy
