"""What an opaque base sends back: directions, and weights that are multiplied by what it reflects."""

from ..._jit import stage
from ...optics.ggx import smith_g1
from ...optics.lambert import sample_cosine
from ..layout import WEIGHT, X, Y, Z
from ..loops import colour, multiply, scale
from ..stages import LAMBERT, ROUGH_CONDUCTOR
from ..stages.lambert import RHO
from ..stages.smooth_conductor import ETA, KAPPA
from .facets import draw_facets
from .layout import (
    BACK_GAIN,
    BACK_X,
    BACK_Y,
    BACK_Z,
    BASE,
    COSINE,
    FACET_RATIO,
    FACET_X,
    FACET_Y,
    FACET_Z,
    POINT_U,
    POINT_V,
    RATIO,
)
from .numbers import facet_numbers


@stage
def meet_base(kind, batch, n, alpha, spectral, scratch):
    """Let ``n`` rays meet an opaque interface; ``POINT_U`` and ``POINT_V`` of ``scratch`` are drawn."""
    x, y, z = batch[X], batch[Y], batch[Z]
    ox, oy, oz, gain = scratch[BACK_X], scratch[BACK_Y], scratch[BACK_Z], scratch[BACK_GAIN]
    if kind == LAMBERT:
        _scatter(n, scratch[POINT_U], scratch[POINT_V], ox, oy, oz, gain)
        for c in range(spectral.shape[1]):
            scale(batch[WEIGHT + c], n, spectral[RHO, c])
    elif kind == ROUGH_CONDUCTOR:
        fx, fy, fz, cosines = scratch[FACET_X], scratch[FACET_Y], scratch[FACET_Z], scratch[COSINE]
        ratios = scratch[FACET_RATIO]
        facet_numbers(scratch[POINT_U], scratch[POINT_V], n, 0, BASE, batch[RATIO], fx, fy, fz, ratios)
        multiply(batch[RATIO], n, ratios)
        draw_facets(x, y, z, n, alpha, fx, fy, fz, cosines)
        _reflect(x, y, z, n, alpha, fx, fy, fz, cosines, ox, oy, oz, gain)
        _colour(batch, n, spectral, cosines)
    else:
        _mirror(x, y, z, n, ox, oy, oz, gain)
        _colour(batch, n, spectral, z)


@stage
def _scatter(n, u, v, ox, oy, oz, gain):
    for i in range(n):
        ox[i], oy[i], oz[i] = sample_cosine(u[i], v[i])
        gain[i] = 1.0


@stage
def _reflect(x, y, z, n, alpha, fx, fy, fz, cosines, ox, oy, oz, gain):
    for i in range(n):
        twice = 2.0 * cosines[i]
        height = twice * fz[i] - z[i]
        ox[i] = x[i] - twice * fx[i]
        oy[i] = y[i] - twice * fy[i]
        oz[i] = height
        gain[i] = smith_g1(height, alpha)


@stage
def _mirror(x, y, z, n, ox, oy, oz, gain):
    for i in range(n):
        ox[i] = x[i]
        oy[i] = y[i]
        oz[i] = z[i]
        gain[i] = 1.0


@stage
def _colour(batch, n, spectral, cosines):
    for c in range(spectral.shape[1]):
        colour(batch[WEIGHT + c], n, cosines, spectral[ETA, c], spectral[KAPPA, c])
