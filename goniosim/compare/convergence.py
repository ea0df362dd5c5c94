"""How far n x n sub-cells are from converged, and integration to convergence where they are not.

Only some cells can be wrong: those in which the values at the sub-cells differ much, their
neighbours (a narrow lobe may stand between the sub-cells of one cell and show in the next), those
at an edge where the values of cells fall by half or more, and those around the mirror direction of a
lobe that is not wider than they are. In all others the error of the midpoint rule is of the order of
spread^2 / (24 n^2), below 1e-3.
"""

from dataclasses import dataclass

import numpy as np

from ..integration import find_lobe, integrate_adaptively, integrate_fixed

# Cells with a larger spread of the values at their sub-cells are suspicious.
SPREAD = 0.25
# An edge lies between cells whose values differ by more than this factor.
EDGE = 0.5
# How many times finer the sub-cells are with which the sub-cells asked for are compared.
FINER = 3
# Error of a converged slice, relative to the root of the integral of f^2 cos(theta_v).
TOLERANCE = 1e-3
# Error of the parts of a cell, relative to the cell, that is small enough whatever the slice holds.
RELATIVE = 1e-4
NODES = 3


@dataclass(frozen=True)
class Levels:
    """Energies of a model in the valid cells of a slice, from coarse to converged.

    Attributes
    ----------
    coarse, finer, converged : ndarray, shape (channels, cells)
        With the sub-cells asked for, with finer ones, and integrated adaptively.
    integration : str
        What ``converged`` took: ``fixed`` where nothing was suspicious, ``adaptive``, or ``exhausted`` if
        cells were given up and that matters.
    """

    coarse: np.ndarray
    finer: np.ndarray
    converged: np.ndarray
    integration: str


def converge(prepared, grid, n, pool, coarse, spread):
    """Integrate a model again where n x n sub-cells may be too coarse.

    Parameters
    ----------
    prepared : goniosim.models.Prepared
    grid : goniosim.integration.Grid
    n : int
        Sub-cells along each side of a cell, in ``coarse``.
    pool : goniosim.integration.Pool
    coarse, spread : ndarray
        From `goniosim.integration.integrate_fixed`.

    Returns
    -------
    Levels
    """
    lobe = find_lobe(grid, prepared.light, prepared.narrowest)
    size = grid.projected_solid_angle[:, : grid.half_columns].ravel()[grid.numbers]
    suspects = _suspects(prepared, grid, spread, (coarse / size).max(axis=0), lobe)
    finer, converged = coarse.copy(), coarse.copy()
    if not len(suspects):
        return Levels(coarse, finer, converged, "fixed")
    numbers = grid.numbers[suspects]
    finer[:, suspects] = integrate_fixed(prepared, grid, FINER * n, pool, numbers)[0]
    # Each part of a cell may spend the cell's share of the error; a difference of two rules overstates it.
    budget = TOLERANCE**2 * (finer**2 / size).sum(axis=1).max() / len(size)
    found = integrate_adaptively(
        prepared,
        grid,
        pool,
        numbers,
        # The finer sub-cells may have missed all there is: then the budget says nothing.
        relative=RELATIVE,
        absolute=np.sqrt(budget * size[suspects]),
        lobe=lobe,
        nodes=NODES,
    )
    converged[:, suspects] = found.energy
    return Levels(coarse, finer, converged, "exhausted" if _matters(found, converged, size, suspects) else "adaptive")


def _matters(found, converged, size, suspects):
    """Whether what was given up is more of an error than a converged slice may have."""
    lost = np.where(found.exhausted, found.error**2, 0.0)
    allowed = TOLERANCE**2 * (converged**2 / size).sum(axis=1)
    return bool(((lost / size[suspects]).sum(axis=1) > allowed).any())


def _suspects(prepared, grid, spread, highest, lobe):
    """Places in ``grid.numbers`` of the cells in which a finer division can matter."""
    half = np.zeros((2, grid.rows * grid.half_columns))
    half[:, grid.numbers] = spread > SPREAD, highest
    marked, highest = grid.unfold(half)
    slices = (marked > 0.0) | _edges(highest)
    if lobe.scale_u < 0.5 * np.pi / grid.rows or lobe.scale_psi < 2.0 * np.pi / grid.columns:
        lx, ly, lz = prepared.light
        row, column = grid.cell_of((-lx, -ly, lz))
        slices[row, column] = True
        if row == 0:
            slices[0] = True
    rows, columns = np.nonzero(slices)
    grown = np.zeros_like(slices)
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            grown[np.clip(rows + i, 0, grid.rows - 1), (columns + j) % grid.columns] = True
    return np.flatnonzero(grown[:, : grid.half_columns].ravel()[grid.numbers])


def _edges(values):
    """Cells, shape (R, K), in which values are less than half of those of a neighbour."""
    higher = np.maximum(np.roll(values, 1, axis=1), np.roll(values, -1, axis=1))
    higher[1:] = np.maximum(higher[1:], values[:-1])
    higher[:-1] = np.maximum(higher[:-1], values[1:])
    return values < EDGE * higher
