"""Integration with a fixed number of sub-cells: fast, and as in Bati et al. 2019.

A cell of the simulation holds the energy that leaves into it, divided by its projected solid angle.
The energy of a density in a cell is the sum over n x n sub-cells of the value at the centre times
the projected solid angle of the sub-cell. Bati et al. 2019 weight by the solid angle; with
energies, the cosine belongs into the weight.
"""

import numpy as np

from .pool import BLOCK
from .subcells import fill_subcells, make_subcells, sum_subcells


def integrate_fixed(density, grid, n, pool, numbers=None):
    """Energy of a density in cells of a slice, from n x n sub-cells.

    Parameters
    ----------
    density : Density
    grid : Grid
    n : int
        Sub-cells along each side of a cell.
    pool : Pool
    numbers : ndarray of int, optional
        Cells to integrate, of ``grid.numbers``; all of them by default.

    Returns
    -------
    energy : ndarray, shape (channels, cells)
        Fraction of the incident flux.
    spread : ndarray, shape (cells,)
        How much the values in a cell differ: (highest - lowest) / mean, the largest of all channels.
    """
    numbers = grid.numbers if numbers is None else numbers
    table = make_subcells(grid, n)
    energy = np.zeros((density.channels, len(numbers)))
    spread = np.zeros(len(numbers))
    step = max(1, BLOCK // (n * n))
    light = grid.light

    def work(start):
        part = numbers[start : start + step]
        x, y, z, weight = np.empty((4, len(part) * n * n))
        values = np.empty((len(energy), len(x)))
        fill_subcells(
            grid.code,
            light,
            part,
            grid.half_columns,
            n,
            table.row,
            table.column,
            table.row_integral,
            table.column_integral,
            x,
            y,
            z,
            weight,
        )
        density.kernel(density.tables, density.light, x, y, z, values)
        sums = np.empty((len(energy), len(part)))
        sum_subcells(values, weight, n * n, sums, spread[start : start + step])
        energy[:, start : start + step] = sums

    pool.in_blocks(work, len(numbers), step)
    return energy, spread
