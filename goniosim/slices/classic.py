"""Classic slices: rows theta_v, columns phi_v, both linear."""

import math

import numpy as np

from .._jit import scalar, stage
from ..optics.elementary import arctan2_first_quadrant, sincos_first_quadrant
from .grid import HALF_PI, cell_number

# Of d omega_v to the solid angle of the axis whose polar angle is `tilt`, besides what `view_direction` returns.
AXIS_JACOBIAN = 1.0
# Whether a row holds the directions of one height, all around the normal.
RINGS = True
# Rows and columns to each side of a cell that are lit alike, where there is little light.
ALIKE = (2, 2)


@stage
def cells_of(x, y, z, n, rows, columns, cell):
    """Cell numbers of ``n`` view vectors (minus x, minus y, z)."""
    for i in range(n):
        theta = arctan2_first_quadrant(math.sqrt(x[i] * x[i] + y[i] * y[i]), z[i])
        cell[i] = cell_number(theta, -x[i], -y[i], z[i], rows, columns)


@scalar
def view_row(u):
    """Sine and cosine of theta_v on the row coordinate ``u``, and the part of the Jacobian that is theirs."""
    sine, cosine = sincos_first_quadrant(u)
    return sine, cosine, sine


@scalar
def view_direction(sine, cosine, cos_phi, sin_phi, lx, ly, lz):
    """View direction (x, y, z) from a row and an azimuth, and the rest of d omega_v / (du dphi)."""
    return sine * cos_phi, sine * sin_phi, cosine, 1.0


@scalar
def horizon_azimuth(u, lx, lz):
    """Azimuth below which the points of row coordinate ``u`` lie above the horizon: all of them do."""
    return math.pi


@scalar
def horizon_coordinate(phi, lx, lz):
    """Row coordinate up to which the points of azimuth ``phi`` lie above the horizon."""
    return HALF_PI


def coordinates(view, light):
    """Row coordinates and azimuths of view directions.

    Parameters
    ----------
    view : array_like, shape (..., 3)
    light : ndarray, shape (3,)

    Returns
    -------
    u, psi : ndarray, shape (...)
        In radians; psi = pi - phi, the azimuth from that opposite to the light, in [-pi, pi].
    """
    x, y, z = np.moveaxis(np.asarray(view, float), -1, 0)
    return np.arctan2(np.hypot(x, y), z), np.arctan2(y, -x)


def directions(u, phi, light):
    """View directions of points of the slice.

    Parameters
    ----------
    u, phi : array_like
        Row coordinates and azimuths in radians; they broadcast.
    light : ndarray, shape (3,)

    Returns
    -------
    ndarray, shape (..., 3)
        Unit vectors, some below the horizon where the slice reaches there.
    """
    u, phi = np.broadcast_arrays(u, phi)
    return np.stack([np.sin(u) * np.cos(phi), np.sin(u) * np.sin(phi), np.cos(u)], axis=-1)


def tilt(u):
    """Angle theta_v of a row coordinate, an array."""
    return u


def projected_row(u, light):
    """Coefficients a, b, c of cos(theta_v) d omega_v = (a cos^2(phi) + b cos(phi) + c) du dphi."""
    none = np.zeros_like(u)
    return none, none, np.sin(u) * np.cos(u)


def geometry(rows, columns, theta):
    """Validity and exact solid angles of all cells; ``theta`` does not matter here.

    Returns
    -------
    valid : ndarray of bool, shape (rows, columns)
    solid_angle, projected_solid_angle : ndarray, shape (rows, columns)
        In sr.
    """
    step = HALF_PI / rows
    d_phi = 2.0 * math.pi / columns
    # Products instead of differences of cosines and squared sines, whole multiples of half a row, and the sine of what
    # is left of a straight angle: no digits are lost, however narrow the rows.
    middle = 2 * np.arange(rows) + 1
    solid = 2.0 * np.sin(0.5 * step * middle) * math.sin(0.5 * step) * d_phi
    projected = 0.5 * np.sin(step * np.minimum(middle, 2 * rows - middle)) * math.sin(step) * d_phi
    shape = (rows, columns)
    return (
        np.ones(shape, dtype=bool),
        np.broadcast_to(solid[:, None], shape).copy(),
        np.broadcast_to(projected[:, None], shape).copy(),
    )
