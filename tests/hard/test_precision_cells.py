"""Cells against 40 digits: rows 1/90 degree wide, half cells that the horizon cuts, light from 0 to 89.999 degrees."""

import math

import mpmath
import numpy as np
import pytest

from benchmarks.precision.case import measure
from benchmarks.precision.cells import CASES
from benchmarks.precision.functions import GROUPS
from goniosim._jit import kernel
from goniosim.slices import PARAMETRIZATIONS, cells_of
from precise import each, holds

HORIZON = GROUPS["horizon"]
# In cell widths; directions nearer than 1e-9 below an edge count as on it.
BESIDE = 3e-9


@each(CASES, "classic geometry")
def test_classic_geometry(case, dense):
    """Differences of nearly equal angles left twelve digits to 8100 rows, and fewer to the last one."""
    holds(case, case.measure(dense))


@each(CASES, "half geometry")
def test_half_geometry(case, dense):
    """Of grazing light the horizon leaves slivers of 1e-20 sr: with differences of sines they had six digits."""
    holds(case, case.measure(dense))


@each(HORIZON, "half ")
def test_half_horizon_and_jacobian(case, dense):
    """The Jacobian vanishes at the pole, and the horizon touches rows at azimuths of 0 and 180 degrees."""
    holds(case, measure(case, dense))


@kernel
def _cells(parametrization, x, y, z, rows, columns, light, cell):
    cells_of(parametrization, x, y, z, x.shape[0], rows, columns, light, cell)


def _direction(u, phi, name, theta):
    """A view direction from its place in a slice, rounded only at the end."""
    if name == "classic":
        return [float(w) for w in (mpmath.sin(u) * mpmath.cos(phi), mpmath.sin(u) * mpmath.sin(phi), mpmath.cos(u))]
    t = 2 * u**2 / mpmath.pi
    h = (mpmath.sin(t) * mpmath.cos(phi), mpmath.sin(t) * mpmath.sin(phi), mpmath.cos(t))
    light = (mpmath.sin(theta), mpmath.mpf(0), mpmath.cos(theta))
    facet = sum(a * b for a, b in zip(light, h, strict=True))
    return [float(2 * facet * a - b) for a, b in zip(h, light, strict=True)]


@pytest.mark.parametrize("name, theta_deg", [("classic", 0.0), *(("half", t) for t in (0.0, 30.0, 85.0, 89.0))])
def test_cells_of_edges(name, theta_deg):
    """Every edge of 90 x 360 cells lies where it should, to 3e-9 of a cell: directions on it, and just below.

    The half vector of more grazing light is that of nearly opposite directions, whose rounding moves it by more.
    """
    rows, columns, theta = 90, 360, math.radians(theta_deg)
    wanted, places = [], []
    with mpmath.workdps(40):
        # Edges of rows on the side of the light, where half slices are above the horizon, and of columns near the pole.
        sides = [(k, 0.5 + (7 * k) % 40, k, (7 * k) % 40) for k in range(1, 90) if name == "classic" or k < 55]
        places += [(u, phi, row, column) for u, phi, row, column in sides]
        places += [(u - BESIDE, phi, row - 1, column) for u, phi, row, column in sides]
        places += [(2.5, k, 2, k) for k in range(columns)]
        places += [(2.5, k - BESIDE, 2, k - 1) for k in range(1, columns)]
        views = [
            _direction(mpmath.pi / 2 * u / rows, 2 * mpmath.pi * phi / columns, name, mpmath.mpf(theta))
            for u, phi, _, _ in places
        ]
        light = np.array([float(mpmath.sin(theta)), 0.0, float(mpmath.cos(theta))])
    x, y, z = np.array(views).T.copy()
    above = z >= 0.0
    assert above.sum() > 400
    cell = np.empty(len(x), np.int32)
    _cells(PARAMETRIZATIONS[name][0], -x, -y, z, rows, columns, light, cell)
    wanted = np.array([row * columns + column for _, _, row, column in places])
    np.testing.assert_array_equal(cell[above], wanted[above])
