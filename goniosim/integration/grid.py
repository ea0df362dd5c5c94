"""The cells of one slice, as the integration sees them.

Light stands at azimuth 0 and all materials are isotropic, so the slice is its own mirror image: only the first
half of the columns is integrated.
"""

import math
from dataclasses import dataclass

import numpy as np

from .._jit import kernel
from ..slices import PARAMETRIZATIONS
from ..slices import cells_of as _cells_of


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
    def module(self):
        """The parametrization itself."""
        return PARAMETRIZATIONS[self.parametrization][1]

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
    def all_numbers(self):
        """Numbers ``row * half_columns + column`` of all cells of the first half."""
        return np.arange(self.rows * self.half_columns)

    @property
    def numbers(self):
        """Those of the valid cells."""
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
        _find_cells(self.code, x, y, z, 1, self.rows, self.columns, self.light, cell)
        return divmod(int(cell[0]), self.columns)


@kernel
def _find_cells(code, x, y, z, n, rows, columns, light, cell):
    _cells_of(code, x, y, z, n, rows, columns, light, cell)
