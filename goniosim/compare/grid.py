"""The cells of one slice, divided into the sub-cells at whose centres a model is evaluated.

Light stands at azimuth 0 and all models are isotropic, so the slice is its own mirror image: only
the first half of the columns is evaluated. Sub-cells are equal steps of the row coordinate and
of the azimuth. The projected solid angle of a sub-cell is exact: in both parametrizations

    cos(theta_v) d omega_v = (a(u) cos^2(phi) + b(u) cos(phi) + c(u)) du dphi,

so it is a sum of products of an integral over the row coordinate and one over the azimuth.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..slices import PARAMETRIZATIONS, cells_of
from ..slices.grid import HALF_PI

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)


@dataclass(frozen=True)
class Grid:
    """The cells of one slice, for one incident direction.

    Attributes
    ----------
    parametrization : str
    rows, columns : int
    theta_deg : float
        Incident polar angle; the light stands at phi = 0.
    valid : ndarray of bool, shape (rows, columns)
    projected_solid_angle : ndarray, shape (rows, columns)
        In sr.
    """

    parametrization: str
    rows: int
    columns: int
    theta_deg: float
    valid: np.ndarray
    projected_solid_angle: np.ndarray

    @property
    def code(self):
        """Number of the parametrization in compiled code."""
        return PARAMETRIZATIONS[self.parametrization][0]

    @property
    def light(self):
        """Unit vector to the light."""
        theta = math.radians(self.theta_deg)
        return np.array([math.sin(theta), 0.0, math.cos(theta)])

    @property
    def half_columns(self):
        """Columns that tell all others."""
        return (self.columns + 1) // 2

    @property
    def numbers(self):
        """Numbers ``row * half_columns + column`` of the valid cells of the first half."""
        return np.flatnonzero(self.valid[:, : self.half_columns].ravel())

    def unfold(self, values):
        """Complete values on the first half of the columns, shape (..., rows * half_columns), to slices."""
        half = values.reshape(*values.shape[:-1], self.rows, self.half_columns)
        columns = np.arange(self.columns)
        return half[..., np.minimum(columns, columns[::-1])]

    def cell_of(self, direction):
        """Row and column of the cell that holds a view direction, by the tie rule of `goniosim.slices`."""
        x, y, z = np.array([[-direction[0]], [-direction[1]], [direction[2]]])
        cell = np.empty(1, np.int32)
        cells_of(self.code, x, y, z, 1, self.rows, self.columns, self.light, cell)
        return divmod(int(cell[0]), self.columns)


def make_grid(cells, direction, theta_deg):
    """The grid of one direction of a result.

    Parameters
    ----------
    cells : goniosim.result.Cells
    direction : int
    theta_deg : float
        Its angle.

    Returns
    -------
    Grid
    """
    rows, columns = cells.valid.shape[1:]
    return Grid(
        parametrization=cells.parametrization,
        rows=rows,
        columns=columns,
        theta_deg=float(theta_deg),
        valid=cells.valid[direction],
        projected_solid_angle=cells.projected_solid_angle[direction],
    )


@dataclass(frozen=True)
class SubCells:
    """Tables from which the sub-cells of a grid are computed.

    Attributes
    ----------
    n : int
        Sub-cells along each side of a cell.
    row : ndarray, shape (rows * n, 2)
        Sine and cosine of theta_v or theta_h at the centres.
    column : ndarray, shape (half_columns * n, 2)
        Sine and cosine of the azimuth at the centres.
    row_integral : ndarray, shape (rows * n, 3)
        Integrals of a, b and c of the formula above.
    column_integral : ndarray, shape (half_columns * n, 3)
        Integrals of cos^2(phi), cos(phi) and 1.
    """

    n: int
    row: np.ndarray
    column: np.ndarray
    row_integral: np.ndarray
    column_integral: np.ndarray


def make_subcells(grid, n):
    """Divide every cell of a grid into ``n`` x ``n`` sub-cells.

    Parameters
    ----------
    grid : Grid
    n : int

    Returns
    -------
    SubCells
    """
    u = np.linspace(0.0, HALF_PI, grid.rows * n + 1)
    phi = np.linspace(0.0, 2.0 * math.pi, grid.columns * n + 1)[: grid.half_columns * n + 1]
    centre = _tilt(grid.parametrization, 0.5 * (u[:-1] + u[1:]))
    middle = 0.5 * (phi[:-1] + phi[1:])
    low, high = phi[:-1], phi[1:]
    width = high - low
    # Products instead of differences of sines: no digits are lost.
    first = 2.0 * np.cos(middle) * np.sin(0.5 * width)
    second = np.cos(2.0 * middle) * np.sin(width)
    return SubCells(
        n=n,
        row=np.stack([np.sin(centre), np.cos(centre)], axis=1),
        column=np.stack([np.sin(middle), np.cos(middle)], axis=1),
        row_integral=_row_integrals(grid, u),
        column_integral=np.stack([0.5 * (width + second), first, width], axis=1),
    )


def _tilt(parametrization, u):
    """Angle theta_v or theta_h of a row coordinate."""
    return u * u / HALF_PI if parametrization == "half" else u


def _row_integrals(grid, u):
    """Integrals over each [u[i], u[i + 1]] of a, b and c, by Gauss-Legendre: exact to rounding."""
    low, width = u[:-1], np.diff(u)
    total = np.zeros((len(low), 3))
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        at = low + 0.5 * (1.0 + node) * width
        total += (0.5 * weight * width)[:, None] * np.stack(_densities(grid, at), axis=1)
    return total


def _densities(grid, u):
    if grid.parametrization == "classic":
        none = np.zeros_like(u)
        return none, none, np.sin(u) * np.cos(u)
    # With d omega_v = 4 (l.h) d omega_h; l.h and v_z are linear in cos(phi_h).
    sine, _, cosine = grid.light
    t = u * u / HALF_PI
    jacobian = 4.0 * np.sin(t) * 2.0 * u / HALF_PI
    p, q = sine * np.sin(t), cosine * np.cos(t)
    a, b = sine * np.sin(2.0 * t), cosine * np.cos(2.0 * t)
    return jacobian * p * a, jacobian * (p * b + q * a), jacobian * q * b
