"""Classic slices: rows theta_v, columns phi_v, both linear."""

import math

import numpy as np

from .._jit import scalar, stage
from ..optics.elementary import arctan2_first_quadrant
from .grid import HALF_PI, cell_number


@stage
def cells_of(x, y, z, n, rows, columns, cell):
    """Cell numbers of ``n`` view vectors (minus x, minus y, z)."""
    for i in range(n):
        theta = arctan2_first_quadrant(math.sqrt(x[i] * x[i] + y[i] * y[i]), z[i])
        cell[i] = cell_number(theta, -x[i], -y[i], z[i], rows, columns)


@scalar
def view_direction(u, phi, lx, ly, lz):
    """View direction (x, y, z) of row coordinate ``u``, and d omega_v / (du dphi)."""
    sine = math.sin(u)
    return sine * math.cos(phi), sine * math.sin(phi), math.cos(u), sine


def mirror_coordinate(theta):
    """Row coordinate of the mirror direction of the polar angle ``theta``, in radians."""
    return theta


def lobe_scales(alpha, theta):
    """Widths in row coordinate and azimuth of the reflection of a GGX lobe of width ``alpha``.

    A half vector tilted by alpha out of the plane of incidence turns the azimuth of v by
    2 alpha cot(theta): at grazing incidence the lobe is a needle.
    """
    return alpha, 2.0 * alpha / max(math.tan(theta), 1e-12)


def geometry(rows, columns, theta):
    """Validity and exact solid angles of all cells; ``theta`` does not matter here.

    Returns
    -------
    valid : ndarray of bool, shape (rows, columns)
    solid_angle, projected_solid_angle : ndarray, shape (rows, columns)
        In sr.
    """
    edge = np.linspace(0.0, HALF_PI, rows + 1)
    low, high = edge[:-1], edge[1:]
    d_phi = 2.0 * math.pi / columns
    # Products instead of differences of cosines and squared sines: no digits are lost.
    solid = 2.0 * np.sin(0.5 * (low + high)) * np.sin(0.5 * (high - low)) * d_phi
    projected = 0.5 * np.sin(low + high) * np.sin(high - low) * d_phi
    shape = (rows, columns)
    return (
        np.ones(shape, dtype=bool),
        np.broadcast_to(solid[:, None], shape).copy(),
        np.broadcast_to(projected[:, None], shape).copy(),
    )
