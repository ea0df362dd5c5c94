"""The cells in which light is counted: one file per slice parametrization.

Every parametrization offers ``cells_of`` (compiled: directions to cell numbers), ``view_direction``
(compiled: row and column coordinate to a direction and the Jacobian) and ``geometry`` (edges,
validity, exact solid angles). A new one is one new file, a line in `PARAMETRIZATIONS`, and a line
in each compiled chooser below.

Cells are half-open: an edge belongs to the cell with the higher number, and azimuth 360 degrees to
column 0. A direction within `SNAP` cell widths below an edge counts as on it, so that rounding
does not decide where the mirror direction of a whole number of degrees falls. The pole of a
parametrization (theta_v = 0 or theta_h = 0) belongs to row 0 and column 0.
"""

from .._jit import kernel
from . import classic, half

CLASSIC, HALF = range(2)
PARAMETRIZATIONS = {"classic": (CLASSIC, classic), "half": (HALF, half)}


@kernel
def cells_of(parametrization, x, y, z, n, rows, columns, light, cell):
    """Cell numbers ``row * columns + column`` of ``n`` view vectors (minus x, minus y, z)."""
    if parametrization == CLASSIC:
        classic.cells_of(x, y, z, n, rows, columns, cell)
    elif parametrization == HALF:
        half.cells_of(x, y, z, n, rows, columns, light, cell)
