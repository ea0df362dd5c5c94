"""From a result to the grids that are integrated, and from integrated energies back to slices."""

import numpy as np

from ..integration import Grid


def grid_of(result, direction):
    """The grid of one direction of a result.

    Parameters
    ----------
    result : goniosim.result.Result
    direction : int

    Returns
    -------
    goniosim.integration.Grid
    """
    cells = result.cells
    rows, columns = cells.valid.shape[1:]
    return Grid(
        parametrization=cells.parametrization,
        rows=rows,
        columns=columns,
        theta_deg=float(result.theta_deg[direction]),
        valid=cells.valid[direction],
        projected_solid_angle=cells.projected_solid_angle[direction],
    )


def to_slice(prepared, grid, energy):
    """Slices of all channels from the energies of ``grid.numbers``.

    Parameters
    ----------
    prepared : goniosim.models.Prepared
        Its ``mirror_energy`` is added to the cell that holds the mirror direction.
    grid : goniosim.integration.Grid
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
        row, column = grid.cell_of((-lx, -ly, lz))
        if grid.valid[row, column]:
            slices[:, row, column] += prepared.mirror_energy
    return slices[prepared.position]


def to_bsdf(energy, cells):
    """Energies per projected solid angle, shape (M, C, R, K); 0 in cells that are not valid."""
    size = cells.projected_solid_angle[:, None]
    lit = cells.valid[:, None] & (size > 0.0)
    return np.divide(energy, size, out=np.zeros_like(energy), where=lit)
