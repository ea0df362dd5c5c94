"""Integration of a model over the cells of a slice, defined as the simulation defines a cell's value.

A cell of the simulation holds the energy that leaves into it, divided by its projected solid angle.
The energy of a model in a cell is the sum over n x n sub-cells of the value at the centre times
the projected solid angle of the sub-cell. Bati et al. 2019 weight by the solid angle; with
energies, the cosine belongs into the weight.
"""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..cores import available_cores
from .grid import make_subcells
from .kernels import fill_subcells, sum_cells

# Directions evaluated at a time: their arrays fit in a core's own cache.
BLOCK = 4096


def make_pool():
    """Threads for the functions of this package; a context manager."""
    return ThreadPoolExecutor(available_cores(), thread_name_prefix="compare")


def integrate(prepared, grid, n, pool, numbers=None):
    """Energy of a model in cells of a slice, without a part that leaves in exactly one direction.

    Parameters
    ----------
    prepared : goniosim.models.Prepared
    grid : Grid
    n : int
        Sub-cells along each side of a cell.
    pool : concurrent.futures.ThreadPoolExecutor
    numbers : ndarray of int, optional
        Cells to integrate, of ``grid.numbers``; all of them by default.

    Returns
    -------
    energy : ndarray, shape (distinct channels, cells)
        Fraction of the incident flux.
    spread : ndarray, shape (cells,)
        How much the values in a cell differ: (highest - lowest) / mean, the largest of all channels.
    """
    numbers = grid.numbers if numbers is None else numbers
    subcells = make_subcells(grid, n)
    energy = np.zeros((len(prepared.mirror_energy), len(numbers)))
    spread = np.zeros(len(numbers))
    step = max(1, BLOCK // (n * n))
    starts = range(0, len(numbers), step)
    light = grid.light

    def work(own_starts):
        for start in own_starts:
            part = numbers[start : start + step]
            x, y, z, weight = np.empty((4, len(part) * n * n))
            values = np.empty((len(energy), len(x)))
            fill_subcells(
                grid.code,
                light,
                part,
                grid.half_columns,
                n,
                subcells.row,
                subcells.column,
                subcells.row_integral,
                subcells.column_integral,
                x,
                y,
                z,
                weight,
            )
            prepared.kernel(prepared.tables, prepared.light, x, y, z, values)
            sums = np.empty((len(energy), len(part)))
            sum_cells(values, weight, n * n, sums, spread[start : start + step])
            energy[:, start : start + step] = sums

    workers = available_cores()
    for _ in pool.map(work, [starts[w::workers] for w in range(workers)]):
        pass
    return energy, spread


def to_slice(prepared, grid, energy):
    """Slices of all channels from the energies of ``grid.numbers``.

    Parameters
    ----------
    prepared : goniosim.models.Prepared
        Its ``mirror_energy`` is added to the cell that holds the mirror direction.
    grid : Grid
    energy : ndarray, shape (distinct channels, cells)

    Returns
    -------
    energy : ndarray, shape (C, R, K)
        0 in cells that are not valid.
    """
    full = np.zeros((len(energy), grid.rows * grid.half_columns))
    full[:, grid.numbers] = energy
    slices = grid.unfold(full)
    if np.any(prepared.mirror_energy):
        lx, ly, lz = prepared.light
        row, column = grid.cell_of(np.array([-lx, -ly, lz]))
        if grid.valid[row, column]:
            slices[:, row, column] += prepared.mirror_energy
    return slices[prepared.position]
