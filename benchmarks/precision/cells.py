"""Solid angles of cells beside those of the definitions."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from mpmath import mp, mpf

from goniosim.slices import classic, half

from .exact import cells as exact
from .outcome import compare, spread

# Quadratures take long, and hide no cancellation.
_DIGITS = 40
SOLID, PROJECTED = range(2)
THETAS = (0.0, 1e-9, 1e-3, 1.0, 30.0, 45.0, 60.0, 75.0, 85.0, 89.0, 89.9, 89.99, 89.999)
SHAPES = ((90, 360), (9, 36), (30, 91), (900, 8))
CLASSIC_ROWS = (1, 2, 7, 90, 180, 900, 8100)


@dataclass(frozen=True)
class Cells:
    """Solid angles of some cells.

    Attributes
    ----------
    name, arguments, grid, sensitive
        As in `benchmarks.precision.case.Case`.
    measure : callable
        Of whether the grid is to be dense: the `Outcome`.
    """

    name: str
    arguments: tuple[str, ...]
    grid: str
    measure: Callable
    sensitive: str = ""


def _classic(which):
    def measure(dense):
        points, found, expected = [], [], []
        for rows in CLASSIC_ROWS if dense else CLASSIC_ROWS[::3]:
            values = classic.geometry(rows, 360, 0.0)[1 + which][:, 0]
            # The pole and the horizon, and some between.
            some = np.unique(np.linspace(0, rows - 1, 91 if dense else 7).astype(int)).tolist()
            points += [(float(rows), float(row)) for row in some]
            found += values[some].tolist()
            with mp.workdps(_DIGITS):
                expected += [exact.classic(rows, 360, row)[which] for row in some]
        return compare(points, found, expected, lambda i: mpf(0))

    return measure


@cache
def _exact_half(*box):
    """Both solid angles, of which the quadrature finds one with the other."""
    with mp.workdps(_DIGITS):
        return exact.half(*box)


def _half(which, wholly):
    def measure(dense):
        points, found, expected, boxes = [], [], [], []
        for theta in np.radians(THETAS if dense else THETAS[4::4]).tolist():
            for rows, columns in SHAPES if dense else SHAPES[1:2]:
                valid, *angles = half.geometry(rows, columns, theta)
                for row, column in _some(valid, angles[SOLID], wholly, 8 if dense else 4):
                    points.append((math.degrees(theta), float(rows), float(columns), float(row), float(column)))
                    found.append(float(angles[which][row, column]))
                    with mp.workdps(_DIGITS):
                        boxes.append((mpf(theta), *exact.half_edges(rows, columns, row, column)))
                    expected.append(_exact_half(*boxes[-1])[which])

        def spread_at(i):
            with mp.workdps(_DIGITS):
                return spread(lambda *box: _exact_half(*box)[which], boxes[i])

        return compare(points, found, expected, spread_at)

    return measure


def _some(valid, solid, wholly, n):
    """Cells above the horizon, or such as it cuts and those below them: some, from the smallest to the largest."""
    rows, columns = valid.shape
    one_side = np.arange(columns) < (columns + 1) // 2
    kind = valid if wholly else ~valid & (solid > 0.0)
    cells = np.argwhere(kind & one_side)
    by_size = cells[np.argsort(solid[tuple(cells.T)], kind="stable")]
    chosen = by_size[np.unique(np.linspace(0, len(by_size) - 1, n).astype(int))].tolist() if len(by_size) else []
    below = [] if wholly else [[row + 1, column] for row, column in chosen if row + 1 < rows]
    return chosen + below


_HALF = ("theta_l (degrees)", "rows", "columns", "row", "column")
_GRID = "theta_l 0 and 1e-9 to 89.999 degrees; 90 x 360, 9 x 36, 30 x 91 and 900 x 8 cells"
_GRAZING = "where the light grazes, so that all heights of a cell hang on its last digits"
_SLIVER = "where the horizon spares next to nothing of a cell, whose edges are rounded"
_ANGLES = ("solid angle", "projected solid angle")

CASES = [
    Cells(f"classic geometry, {name}", ("rows", "row"), "1 to 8100 rows of 360 columns", _classic(which))
    for which, name in enumerate(_ANGLES)
]
CASES += [
    Cells(f"half geometry, {_ANGLES[which]}, {kind}", _HALF, _GRID, _half(which, wholly), sensitive)
    for which, wholly, kind, sensitive in (
        (SOLID, True, "cells above the horizon", ""),
        (PROJECTED, True, "cells above the horizon", _GRAZING),
        (SOLID, False, "cells that it cuts", _SLIVER),
        (PROJECTED, False, "cells that it cuts", _SLIVER),
    )
]
