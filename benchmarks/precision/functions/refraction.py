"""Snell's law in both directions."""

from goniosim._jit import kernel
from goniosim.optics.refraction import refracted_cosine, refraction_shift

from .. import grids
from ..case import Case
from ..exact import refraction as exact


@kernel
def _refracted(p, out):
    for i in range(p.shape[1]):
        below = refracted_cosine(p[0, i], p[1, i])
        out[0, i] = below
        # Under total internal reflection it means nothing.
        out[1, i] = refraction_shift(p[0, i], p[1, i], below) if below > 0.0 else 0.0


def _points(dense):
    # Ratios are indices the other way round: critical angles at 1 / eta.
    points = grids.fresnel(dense)
    points[1] = 1.0 / points[1]
    return points


_GRID = "cos 1e-16 to 1 and 1 - 10^-k, ratio .1 to 20 and 1 ± 10^-k, critical angles ± 10^-k"
_ARGUMENTS = ("cosine", "ratio")

CASES = [
    Case(
        "refracted_cosine",
        _ARGUMENTS,
        _points,
        _GRID + "; below 1e-15 it need only be that small",
        _refracted,
        exact.cosine_below,
        floor=1e-15,
    ),
    Case("refraction_shift", _ARGUMENTS, _points, _GRID, _refracted, exact.shift, 1),
]
