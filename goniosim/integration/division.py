"""How rectangles of a slice are divided: towards a lobe, across the direction of the error, at the horizon."""

import math

import numpy as np

from .._jit import kernel, scalar, stage
from ..slices import horizon_azimuth, horizon_coordinate
from .rectangle import D_PSI, D_U, PSI, U

# Parts of one rectangle at most: four, each perhaps cut in two by the horizon.
MOST_PARTS = 8
# What the parts of a rectangle cannot tell of its error.
ALL_TOLD, ONE_SIDE, UNSEEN_PEAK = range(3)
# How far a lobe reaches, in units of its extent, and the extent in azimuth of one that reaches the pole: there
# the azimuth does not matter, but a wide lobe of grazing light is a needle at its peak and wide at the pole.
REACH = 8.0
AROUND = 0.1
# How much longer, in units of the lobe, or more bent, one side must be to be divided alone.
LOPSIDED = 4.0
# A density that bends more, relative to its mean, is not integrated well, whatever the tolerance.
BENT = 0.05


def whole_cells(grid, numbers):
    """Rectangles of cells, cut at the horizon.

    Parameters
    ----------
    grid : Grid
    numbers : ndarray of int
        Cells of the first half of the columns.

    Returns
    -------
    rectangles : ndarray, shape (n, 4)
    owner : ndarray of int, shape (n,)
        Places in ``numbers``; a cell below the horizon owns nothing.
    copies : ndarray, shape (len(numbers),)
        How many times the rectangles of a cell make up the cell: of the middle one of an odd number of
        columns, which is its own mirror image, they are a half.
    """
    row, column = np.divmod(numbers, grid.half_columns)
    d_u, d_psi = 0.5 * math.pi / grid.rows, 2.0 * math.pi / grid.columns
    copies = np.where(2 * column + 1 == grid.columns, 2.0, 1.0)
    psi = np.maximum(0.5 * grid.columns - 1.0 - column, 0.0) * d_psi
    boxes = np.stack([row * d_u, psi, np.full(len(row), d_u), d_psi / copies], axis=1)
    rectangles = np.empty((2 * len(boxes), 4))
    owner = np.empty(2 * len(boxes), np.int64)
    n = _at_the_horizon(grid.code, grid.light, boxes, rectangles, owner)
    return rectangles[:n], owner[:n], copies


@kernel
def _at_the_horizon(code, light, boxes, rectangles, owner):
    n = 0
    for k in range(boxes.shape[0]):
        before = n
        n = _emit(code, light, boxes[k, U], boxes[k, PSI], boxes[k, D_U], boxes[k, D_PSI], rectangles, n)
        owner[before:n] = k
    return n


@stage
def _emit(code, light, u, psi, d_u, d_psi, rectangles, n):
    """Append the visible part of a rectangle: below the horizon's first cut, and between both cuts."""
    lx = light[0]
    lz = light[2]
    first = min(max(horizon_coordinate(code, math.pi - psi, lx, lz) - u, 0.0), d_u)
    second = min(max(horizon_coordinate(code, math.pi - psi - d_psi, lx, lz) - u, 0.0), d_u)
    if first > 0.0:
        rectangles[n, U] = u
        rectangles[n, PSI] = psi
        rectangles[n, D_U] = first
        rectangles[n, D_PSI] = d_psi
        n += 1
    if second > first:
        # Down to what the lowest row shows: halves of more than that would not divide what is seen.
        hidden = min(max(math.pi - horizon_azimuth(code, u + first, lx, lz) - psi, 0.0), d_psi)
        rectangles[n, U] = u + first
        rectangles[n, PSI] = psi + hidden
        rectangles[n, D_U] = second - first
        rectangles[n, D_PSI] = d_psi - hidden
        n += 1
    return n


@kernel
def divide(code, light, lobe, rectangles, bends, square, premature, parts, parent, quarter):
    """Divide every rectangle.

    Parameters
    ----------
    code : int
    light : ndarray, shape (3,)
    lobe : ndarray, shape (4,)
        Of `goniosim.integration.Lobe`: coordinates of the peak, and extents.
    rectangles : ndarray, shape (n, 4)
    bends : ndarray, shape (2, n)
        From `rule.evaluate`.
    square : ndarray of bool, shape (n,)
        Rectangles to be divided along both sides alike, whatever they look like.
    premature : ndarray of int, shape (n,), out
        What the parts cannot tell of the error of the whole: `UNSEEN_PEAK` if it holds the peak of the lobe and
        is too large to show it, `ONE_SIDE` if it was divided along one side only; `ALL_TOLD` otherwise.
    parts : ndarray, shape (MOST_PARTS * n, 4), out
    parent : ndarray of int, shape (MOST_PARTS * n,), out
    quarter : ndarray of int, shape (MOST_PARTS * n,), out
        Number of the quarter that a part is; -1 where the rectangle is divided otherwise, or the horizon cuts it.

    Returns
    -------
    int
        Number of parts, in the order of their parents.
    """
    count = 0
    for k in range(rectangles.shape[0]):
        u = rectangles[k, U]
        psi = rectangles[k, PSI]
        d_u = rectangles[k, D_U]
        d_psi = rectangles[k, D_PSI]
        long_u = d_u / lobe[2]
        long_psi = d_psi / lobe[3]
        n_u = 2
        n_psi = 2
        if _is_near(lobe, u, psi, d_u, d_psi) & (max(long_u, long_psi) > 1.0):
            premature[k] = UNSEEN_PEAK
            # Across only, as long as the lobe looks narrower from there.
            n_psi = 1 if long_u > LOPSIDED * long_psi else (4 if long_psi > LOPSIDED * long_u else 2)
            n_u = 1 if n_psi == 4 else (4 if n_psi == 1 else 2)
        elif not square[k]:
            if bends[0, k] > max(BENT, LOPSIDED * bends[1, k]):
                n_psi = 1
            elif bends[1, k] > max(BENT, LOPSIDED * bends[0, k]):
                n_u = 1
            premature[k] = ONE_SIDE if n_u * n_psi == 2 else ALL_TOLD
        else:
            premature[k] = ALL_TOLD
        before = count
        is_cut = horizon_coordinate(code, math.pi - psi, light[0], light[2]) < u + d_u
        for i in range(n_u):
            for j in range(n_psi):
                count = _emit(
                    code,
                    light,
                    u + i * (d_u / n_u),
                    psi + j * (d_psi / n_psi),
                    d_u / n_u,
                    d_psi / n_psi,
                    parts,
                    count,
                )
        parent[before:count] = k
        are_quarters = (n_u == 2) & (n_psi == 2) & (count == before + 4) & (not is_cut)
        for i in range(before, count):
            quarter[i] = i - before if are_quarters else -1
    return count


@scalar
def _is_near(lobe, u, psi, d_u, d_psi):
    """Whether the peak lies in a rectangle, or next to it by less than half its size."""
    # A lobe that reaches the pole of the slice lies at every azimuth.
    at_the_pole = (lobe[0] <= REACH * lobe[2]) & (lobe[3] > AROUND)
    around = (abs(psi + 0.5 * d_psi - lobe[1]) <= d_psi) | at_the_pole
    return (abs(u + 0.5 * d_u - lobe[0]) <= d_u) & around
