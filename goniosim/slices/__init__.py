"""The cells in which light is counted: one file per slice parametrization.

Every parametrization offers, compiled, ``cells_of`` (directions to cell numbers), ``view_row`` and
``view_direction`` (row and column coordinate to a direction and the Jacobian), ``horizon_azimuth`` and
``horizon_coordinate`` (where the slice ends); and in Python ``directions`` and its inverse ``coordinates``,
``tilt``, ``AXIS_JACOBIAN`` and ``projected_row`` (exact solid angles of parts of cells), ``geometry`` (validity and
solid angles of all cells), ``RINGS`` and ``ALIKE``. A new one is one new file, a line in `PARAMETRIZATIONS`, and a
line in each compiled chooser below.

Cells are half-open: an edge belongs to the cell with the higher number, and azimuth 360 degrees to
column 0. A direction within `SNAP` cell widths below an edge counts as on it, so that rounding
does not decide where the mirror direction of a whole number of degrees falls. The pole of a
parametrization (theta_v = 0 or theta_h = 0) belongs to row 0 and column 0.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .._jit import scalar, stage
from . import classic, half

CLASSIC, HALF = range(2)
PARAMETRIZATIONS = {"classic": (CLASSIC, classic), "half": (HALF, half)}


@stage
def cells_of(parametrization, x, y, z, n, rows, columns, light, cell):
    """Cell numbers ``row * columns + column`` of ``n`` view vectors (minus x, minus y, z)."""
    if parametrization == CLASSIC:
        classic.cells_of(x, y, z, n, rows, columns, cell)
    elif parametrization == HALF:
        half.cells_of(x, y, z, n, rows, columns, light, cell)


@scalar
def view_row(parametrization, u):
    """What all points of a row share: see the parametrizations."""
    if parametrization == CLASSIC:
        return classic.view_row(u)
    return half.view_row(u)


@scalar
def view_direction(parametrization, sine, cosine, cos_phi, sin_phi, lx, ly, lz):
    """View direction of a point of the slice; with `view_row`, d omega_v / (du dphi)."""
    if parametrization == CLASSIC:
        return classic.view_direction(sine, cosine, cos_phi, sin_phi, lx, ly, lz)
    return half.view_direction(sine, cosine, cos_phi, sin_phi, lx, ly, lz)


@scalar
def horizon_azimuth(parametrization, u, lx, lz):
    """Azimuth below which, in [0, pi], the points of row coordinate ``u`` lie above the horizon."""
    if parametrization == CLASSIC:
        return classic.horizon_azimuth(u, lx, lz)
    return half.horizon_azimuth(u, lx, lz)


@scalar
def horizon_coordinate(parametrization, phi, lx, lz):
    """Row coordinate up to which the points of azimuth ``phi`` lie above the horizon."""
    if parametrization == CLASSIC:
        return classic.horizon_coordinate(phi, lx, lz)
    return half.horizon_coordinate(phi, lx, lz)


@dataclass(frozen=True)
class Geometry:
    """The cells of one slice.

    Attributes
    ----------
    valid : ndarray of bool, shape (rows, columns)
        Cells wholly above the horizon.
    solid_angle, projected_solid_angle : ndarray, shape (rows, columns)
        Of the part above the horizon, in sr.
    """

    valid: np.ndarray
    solid_angle: np.ndarray
    projected_solid_angle: np.ndarray


# Cells of a slice that is kept: as many as usual. Finer ones would fill the memory.
_KEPT_CELLS = 1 << 15


def slice_geometry(parametrization, rows, columns, theta_deg):
    """Cells of the slice for light at ``theta_deg``; ``parametrization`` by name.

    Kept for the next scene of a study, unless it is fine: the arrays cannot be written to.
    """
    find = _kept_geometry if rows * columns <= _KEPT_CELLS else _geometry
    return find(parametrization, rows, columns, float(theta_deg))


def _geometry(parametrization, rows, columns, theta_deg):
    arrays = PARAMETRIZATIONS[parametrization][1].geometry(rows, columns, math.radians(theta_deg))
    for array in arrays:
        array.setflags(write=False)
    return Geometry(*arrays)


_kept_geometry = lru_cache(maxsize=128)(_geometry)
