"""docs/precision.md: what the numbers mean, then the table."""

from . import table
from .outcome import LIMIT, UNITS

PAGE = """\
# How exact the functions are

Every scalar function of `goniosim/optics`, and every solid angle of a cell, against the same mathematics in mpmath with
40 digits and more. `make precision` measures all of it, {points} values, and writes this page; `make test` holds a
coarser grid to the same limits, `make test-all` this one.

* The oracles (`benchmarks/precision/exact`) are the formulas of the books and share no code with goniosim. They are
  given the very floats that the function is given: that an argument was rounded before excuses nothing.
* Grids are logarithmic and reach to where digits get lost: cosines from 1e-16 and up to 1 − 1e-15, indices 1 ± 1e-15,
  angles within 1e-15 of the critical one, widths of 1e-6, light at 89.999 degrees.
* **The relative error stays below {limit:g}.** The last column names the exceptions, with the condition number of the
  worst: how many times a relative error of the arguments grows on its way to the value. There the error is told in
  *units*: what half a unit in the last place of the arguments changes the value by. Allowed are {allowed}.
* Half cells that the horizon cuts are compared with a quadrature over the part above it. Their arguments are the angle
  of the light and the four edges of the cell.
* Samplers are maps from random numbers to directions. The table shows that the maps are computed as they should be.
  That they have the densities they should, G1 D(m) max(0, w.m) / w_z for visible normals and cos θ / π for Lambert, is
  shown for the oracles: density times Jacobian is 1 to within {normals} and {cosines}.

{table}
"""


def page(say=lambda name: None):
    """The text of the page."""
    found = table.lines(True, say)
    normals, cosines = (f"{float(deviation):.0e}" for deviation in table.deviations(True))
    return PAGE.format(
        points=f"{sum(line.outcome.points for line in found):,}".replace(",", " "),
        limit=LIMIT,
        allowed=UNITS,
        normals=normals,
        cosines=cosines,
        table=table.markdown(found),
    )
