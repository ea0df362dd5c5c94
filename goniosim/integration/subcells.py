"""The equal sub-cells at whose centres a density is evaluated, with their exact projected solid angles.

Sub-cells are equal steps of the row coordinate and of the azimuth. The projected solid angle of a
sub-cell is exact: in both parametrizations

    cos(theta_v) d omega_v = (a(u) cos^2(phi) + b(u) cos(phi) + c(u)) du dphi,

so it is a sum of products of an integral over the row coordinate and one over the azimuth.
"""

import math
from dataclasses import dataclass

import numpy as np

from .._jit import kernel
from ..slices import view_direction
from ..slices.grid import HALF_PI

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)


@dataclass(frozen=True)
class SubCells:
    """Tables from which the sub-cells of a grid are computed.

    Attributes
    ----------
    n : int
        Sub-cells along each side of a cell.
    row : ndarray, shape (rows * n, 2)
        Sine and cosine of theta_v or theta_h at the centres.
    column : ndarray, shape (half_columns * n, 2)
        Sine and cosine of the azimuth at the centres.
    row_integral : ndarray, shape (rows * n, 3)
        Integrals of a, b and c of the formula above.
    column_integral : ndarray, shape (half_columns * n, 3)
        Integrals of cos^2(phi), cos(phi) and 1.
    """

    n: int
    row: np.ndarray
    column: np.ndarray
    row_integral: np.ndarray
    column_integral: np.ndarray


def make_subcells(grid, n):
    """Divide every cell of a grid into ``n`` x ``n`` sub-cells.

    Parameters
    ----------
    grid : Grid
    n : int

    Returns
    -------
    SubCells
    """
    u = np.linspace(0.0, HALF_PI, grid.rows * n + 1)
    phi = np.linspace(0.0, 2.0 * math.pi, grid.columns * n + 1)[: grid.half_columns * n + 1]
    centre = grid.module.tilt(0.5 * (u[:-1] + u[1:]))
    middle = 0.5 * (phi[:-1] + phi[1:])
    low, high = phi[:-1], phi[1:]
    width = high - low
    # Products instead of differences of sines: no digits are lost.
    first = 2.0 * np.cos(middle) * np.sin(0.5 * width)
    second = np.cos(2.0 * middle) * np.sin(width)
    return SubCells(
        n=n,
        row=np.stack([np.sin(centre), np.cos(centre)], axis=1),
        column=np.stack([np.sin(middle), np.cos(middle)], axis=1),
        row_integral=_row_integrals(grid, u),
        column_integral=np.stack([0.5 * (width + second), first, width], axis=1),
    )


def _row_integrals(grid, u):
    """Integrals over each [u[i], u[i + 1]] of a, b and c, by Gauss-Legendre: exact to rounding."""
    low, width = u[:-1], np.diff(u)
    total = np.zeros((len(low), 3))
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        at = low + 0.5 * (1.0 + node) * width
        total += (0.5 * weight * width)[:, None] * np.stack(grid.module.projected_row(at, grid.light), axis=1)
    return total


@kernel
def fill_subcells(code, light, numbers, half_columns, n, row, column, row_integral, column_integral, x, y, z, weight):
    """View directions at the centres of all sub-cells of some cells, and projected solid angles.

    ``numbers`` are those of `goniosim.integration.Grid.numbers`; each cell fills n * n consecutive
    entries of ``x``, ``y``, ``z`` and ``weight``.
    """
    at = 0
    for k in range(numbers.shape[0]):
        first_row = numbers[k] // half_columns * n
        first_column = numbers[k] % half_columns * n
        for i in range(first_row, first_row + n):
            a = row_integral[i, 0]
            b = row_integral[i, 1]
            c = row_integral[i, 2]
            here_x = x[at : at + n]
            here_y = y[at : at + n]
            here_z = z[at : at + n]
            here_weight = weight[at : at + n]
            azimuths = column[first_column : first_column + n]
            integrals = column_integral[first_column : first_column + n]
            for j in range(n):
                here_x[j], here_y[j], here_z[j], _ = view_direction(
                    code, row[i, 0], row[i, 1], azimuths[j, 1], azimuths[j, 0], light[0], light[1], light[2]
                )
                here_weight[j] = a * integrals[j, 0] + b * integrals[j, 1] + c * integrals[j, 2]
            at += n


@kernel
def sum_subcells(values, weight, per_cell, energy, spread):
    """Weighted sums over ``per_cell`` consecutive entries.

    Parameters
    ----------
    values : ndarray, shape (channels, cells * per_cell)
    weight : ndarray, shape (cells * per_cell,)
    energy : ndarray, shape (channels, cells)
        Receives the sums.
    spread : ndarray, shape (cells,)
        Receives the largest of all channels of (highest - lowest value) / mean value; 0 in the dark.
    """
    for k in range(spread.shape[0]):
        spread[k] = 0.0
    for c in range(values.shape[0]):
        for k in range(spread.shape[0]):
            total = 0.0
            plain = 0.0
            lowest = math.inf
            highest = 0.0
            for i in range(k * per_cell, (k + 1) * per_cell):
                value = values[c, i]
                total += weight[i] * value
                plain += value
                lowest = min(lowest, value)
                highest = max(highest, value)
            energy[c, k] = total
            if plain > 0.0:
                spread[k] = max(spread[k], (highest - lowest) * per_cell / plain)
