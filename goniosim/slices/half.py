"""Half slices: rows u = sqrt(theta_h pi / 2), columns phi_h, with h = normalize(l + v).

The row coordinate is that of the MERL data base (Matusik et al. 2003). A view direction is
v = 2 (l.h) h - l, hence d omega_v = 4 (l.h) d omega_h, and its height is

    v_z = sin(theta_l) sin(2 theta_h) cos(phi_h) + cos(theta_l) cos(2 theta_h),

so for a given theta_h the part of the circle above the horizon is |phi_h| < phi_0(theta_h).
"""

import math
from functools import cache

import numpy as np

from .._jit import scalar, stage
from ..optics.elementary import arctan2_first_quadrant, sincos_first_quadrant
from .grid import HALF_PI, cell_number

# Of d omega_v to the solid angle of the axis whose polar angle is `tilt`, besides what `view_direction` returns.
AXIS_JACOBIAN = 4.0

# Gauss-Legendre nodes for a cell above the horizon, for a high one, and for one that the horizon cuts.
_NODES = 10
_NODES_HIGH = 32
_NODES_CUT = 96
# Rows are high if there are fewer than this. Of high cells that are cut, both ends, as high as a row of so many,
# are panels of their own: there the horizon of grazing light turns.
_ROWS = 90
# Cells at a time, so that memory stays bounded on fine slices.
_BLOCK = 1 << 16

# Whether a row holds the directions of one height, all around the normal.
RINGS = False
# Rows and columns to each side of a cell that are lit alike, where there is little light: it depends on theta_h above
# all, and so does the size of the cells.
ALIKE = (0, 12)


@stage
def cells_of(x, y, z, n, rows, columns, light, cell):
    """Cell numbers of ``n`` view vectors (minus x, minus y, z), seen from ``light``."""
    lx = light[0]
    ly = light[1]
    lz = light[2]
    for i in range(n):
        hx = lx - x[i]
        hy = ly - y[i]
        hz = lz + z[i]
        theta_h = arctan2_first_quadrant(math.sqrt(hx * hx + hy * hy), hz)
        cell[i] = cell_number(math.sqrt(theta_h * HALF_PI), hx, hy, hz, rows, columns)


@scalar
def view_row(u):
    """Sine and cosine of theta_h on the row coordinate ``u``, and the part of the Jacobian that is theirs."""
    sine, cosine = sincos_first_quadrant(u * u / HALF_PI)
    return sine, cosine, 4.0 * sine * (2.0 * u / HALF_PI)


@scalar
def view_direction(sine, cosine, cos_phi, sin_phi, lx, ly, lz):
    """View direction (x, y, z) from a row and an azimuth, and the rest of d omega_v / (du dphi): l.h."""
    hx = sine * cos_phi
    hy = sine * sin_phi
    facet = lx * hx + ly * hy + lz * cosine
    return 2.0 * facet * hx - lx, 2.0 * facet * hy - ly, 2.0 * facet * cosine - lz, max(0.0, facet)


@scalar
def horizon_azimuth(u, lx, lz):
    """Azimuth phi_0 in [0, pi]: points of row coordinate ``u`` with phi_h < phi_0 lie above the horizon."""
    theta = u * u / HALF_PI
    a = lx * math.sin(2.0 * theta)
    b = lz * math.cos(2.0 * theta)
    return math.acos(max(-1.0, -b / a)) if a > abs(b) else (math.pi if b > 0.0 else 0.0)


@scalar
def horizon_coordinate(phi, lx, lz):
    """Row coordinate up to which the points of azimuth ``phi`` lie above the horizon."""
    return math.sqrt(0.5 * math.atan2(lz, -lx * math.cos(phi)) * HALF_PI)


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
    x, y, z = np.moveaxis(np.asarray(view, float) + light, -1, 0)
    return np.sqrt(np.arctan2(np.hypot(x, y), z) * HALF_PI), np.arctan2(y, -x)


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
    theta, phi = np.broadcast_arrays(tilt(np.asarray(u)), phi)
    axis = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    return 2.0 * (axis @ light)[..., None] * axis - light


def tilt(u):
    """Angle theta_h of a row coordinate, an array."""
    return u * u / HALF_PI


def projected_row(u, light):
    """Coefficients a, b, c of cos(theta_v) d omega_v = (a cos^2(phi) + b cos(phi) + c) du dphi."""
    # With d omega_v = 4 (l.h) d omega_h; l.h and v_z are linear in cos(phi_h).
    sine, _, cosine = light
    t = tilt(u)
    jacobian = 4.0 * np.sin(t) * 2.0 * u / HALF_PI
    p, q = sine * np.sin(t), cosine * np.cos(t)
    a, b = sine * np.sin(2.0 * t), cosine * np.cos(2.0 * t)
    return jacobian * p * a, jacobian * (p * b + q * a), jacobian * q * b


def geometry(rows, columns, theta):
    """Validity and exact solid angles of all cells for light at polar angle ``theta``.

    Closed form in phi_h, Gauss-Legendre in theta_h on intervals without kinks: exact to rounding, which where the
    horizon spares next to nothing of a cell is that of the cell's edges (docs/precision.md).

    Returns
    -------
    valid : ndarray of bool, shape (rows, columns)
        Cells wholly above the horizon.
    solid_angle, projected_solid_angle : ndarray, shape (rows, columns)
        Of the part above the horizon, in sr.
    """
    edge_theta = np.linspace(0.0, HALF_PI, rows + 1) ** 2 / HALF_PI
    # The slice is its own mirror image: the first half of the columns tells the rest.
    edge_phi = np.linspace(0.0, 2.0 * math.pi, columns + 1)[: (columns + 1) // 2 + 1]
    shape = (rows, len(edge_phi) - 1)
    valid = np.empty(rows * shape[1], bool)
    solid = np.zeros(len(valid))
    projected = np.zeros(len(valid))
    for first in range(0, len(valid), _BLOCK):
        block = slice(first, first + _BLOCK)
        row, column = np.divmod(np.arange(first, min(first + _BLOCK, len(valid))), shape[1])
        box = (edge_theta[row], edge_theta[row + 1], edge_phi[column], edge_phi[column + 1])
        valid[block], solid[block], projected[block] = _integrate(*box, theta, _ROWS // rows)
    mirrored = np.minimum(np.arange(columns), np.arange(columns)[::-1])
    return tuple(half.reshape(shape)[:, mirrored] for half in (valid, solid, projected))


def _integrate(low, high, start, end, theta, high_rows):
    """Validity and solid angles of cells [low, high] x [start, end], ``high_rows`` times as high as usual."""
    # The height has no minimum inside a cell, and a maximum above the horizon only if a corner is
    # above it too; phi = 180 deg may lie inside the middle one of an odd number of columns.
    farthest = np.where((start < math.pi) & (end > math.pi), math.pi, start)
    heights = [_height(t, phi, theta) for t in (low, high) for phi in (start, end, farthest)]
    valid = np.min(heights, axis=0) >= 0.0
    cut = ~valid & (np.max(heights, axis=0) > 0.0)

    # The horizon crosses the column edges, and the middle of the slice, at these theta_h: between them
    # nothing has a kink.
    crossings = [start, end, farthest] if (farthest > start).any() else [start, end]
    kinks = [np.clip(_horizon(phi, theta), low, high) for phi in crossings]
    bounds = np.sort(np.stack([low, *kinks, high]), axis=0)
    solid = np.zeros_like(low)
    projected = np.zeros_like(low)
    inner = [1.0 / high_rows, 1.0 - 1.0 / high_rows] if high_rows > 2 else [0.5] * (high_rows == 2)
    for kind, shares, nodes in (
        (valid, (0.0, 1.0), _NODES_HIGH if high_rows > 1 else _NODES),
        (cut, (0.0, *inner, 1.0), _NODES_CUT),
    ):
        # What lies beyond the last kink of a cell that is cut is below the horizon.
        for a, b in zip(bounds[:-1], bounds[1:] if kind is valid else bounds[1:-1], strict=False):
            (some,) = np.nonzero(kind & (b > a))
            if len(some) == 0:
                continue
            edges = a[some] + np.multiply.outer(shares, b[some] - a[some])
            d_solid, d_projected = _piece(edges[:-1], edges[1:], start[some], end[some], theta, nodes)
            solid[some] += d_solid.sum(axis=0)
            projected[some] += d_projected.sum(axis=0)
    return valid, solid, projected


def _piece(a, b, start, end, theta, n_nodes):
    """Integrals over theta_h in [a, b] and the visible part of phi_h in [start, end]."""
    solid = np.zeros_like(a)
    projected = np.zeros_like(a)
    for node, weight in zip(*_gauss_legendre(n_nodes), strict=True):
        # A cubic change of variable flattens the square-root ends of phi_0(theta_h).
        s = 0.5 * (1.0 + node)
        t = a + (b - a) * s * s * (3.0 - 2.0 * s)
        factor = 0.5 * weight * (b - a) * 6.0 * s * (1.0 - s) * np.sin(t)
        d_solid, d_projected = _ring(t, start, end, theta)
        solid += factor * d_solid
        projected += factor * d_projected
    return solid, projected


@cache
def _gauss_legendre(n):
    return np.polynomial.legendre.leggauss(n)


def _height(t, phi, theta):
    return math.sin(theta) * np.sin(2.0 * t) * np.cos(phi) + math.cos(theta) * np.cos(2.0 * t)


def _horizon(phi, theta):
    return 0.5 * np.arctan2(math.cos(theta), -math.sin(theta) * np.cos(phi))


def _ring(t, start, end, theta):
    """Integrals over the visible part of phi_h in [start, end] of 4 (l.h) and 4 (l.h) v_z."""
    p = math.sin(theta) * np.sin(t)
    q = math.cos(theta) * np.cos(t)
    a = math.sin(theta) * np.sin(2.0 * t)
    # v_z at phi_h = 0 and at 180 deg; the first over minus the second is the squared tangent of phi_0 / 2.
    highest = np.maximum(0.0, np.cos(2.0 * t - theta))
    lowest = np.cos(2.0 * t + theta)
    phi_0 = 2.0 * np.arctan2(np.sqrt(highest), np.sqrt(np.maximum(0.0, -lowest)))
    lowest = np.maximum(0.0, lowest)
    solid = np.zeros_like(p)
    projected = np.zeros_like(p)
    # Only what reaches beyond 180 deg can meet the other half of the slice.
    spans = [(0.0, phi_0), (2.0 * math.pi - phi_0, 2.0 * math.pi)]
    for low, high in spans if end.max() > math.pi else spans[:1]:
        i = np.clip(start, low, high)
        j = np.clip(end, low, high)
        d = j - i
        middle = 0.5 * (i + j)
        beside = np.minimum(middle, 2.0 * math.pi - middle)
        cosine = np.cos(middle)
        # l.h and v_z in the middle, and the integrals of what cos(phi_h) differs by from its value there, and of the
        # square of that: differences of nearly equal numbers would leave few digits to what the horizon spares.
        facet = p * cosine + q
        height = 2.0 * a * np.sin(0.5 * (phi_0 + beside)) * np.sin(0.5 * (phi_0 - beside)) + lowest
        once = _excess(0.5 * d)
        # (d - sin(d)) / 2
        twice = once + 2.0 * (0.5 * d - once) * np.sin(0.25 * d) ** 2
        first = -2.0 * cosine * once
        second = cosine * cosine * (4.0 * once - 2.0 * twice) + twice
        solid += 4.0 * (facet * d + p * first)
        projected += 4.0 * (facet * height * d + (facet * a + p * height) * first + p * a * second)
    return solid, projected


def _excess(x):
    """``x - sin(x)`` for x >= 0, to its last digits."""
    z = x * x
    series = np.ones_like(x)
    for n in range(18, 3, -2):
        series = 1.0 - z / (n * (n + 1)) * series
    return np.where(x < 1.0, x * z / 6.0 * series, x - np.sin(x))
