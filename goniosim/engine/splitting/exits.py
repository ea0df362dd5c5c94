"""Exits of which nothing goes on inside: facets that only let light through.

There are many for each arrival, so that this is where the time goes. As in `goniosim.engine.stages.facets` normals
keep the length at which they are found, which spares roots and divisions.
"""

from ..._jit import stage
from ...optics.elementary import sincos_turns
from ...optics.fresnel import scaled_transmittance
from ...optics.ggx import sample_visible_facet, smith_g1_scaled
from ..lattice import coordinate
from ..layout import X, Y, Z
from .layout import (
    AMOUNT,
    FACET_RATIO,
    FACET_X,
    FACET_Y,
    FACET_Z,
    POINT_U,
    POINT_V,
    RATIO,
    THROUGH_X,
    THROUGH_Y,
    THROUGH_Z,
)
from .numbers import far_facet, steps_of


@stage
def let_through(batch, n, number, dimension, alpha, eta, share, scratch):
    """What the ``number``-th facet of each of ``n`` rays lets through: directions, and shares of the rays' weights."""
    step_u, step_v = steps_of(dimension)
    x, y, z = batch[X], batch[Y], batch[Z]
    fx, fy, fz, ratios = scratch[FACET_X], scratch[FACET_Y], scratch[FACET_Z], scratch[FACET_RATIO]
    _find_facets(x, y, z, n, alpha, scratch[POINT_U], scratch[POINT_V], number, step_u, step_v, fx, fy, fz, ratios)
    ox, oy, oz, amount = scratch[THROUGH_X], scratch[THROUGH_Y], scratch[THROUGH_Z], scratch[AMOUNT]
    _refract(x, y, z, n, alpha, eta, fx, fy, fz, ratios, batch[RATIO], share, ox, oy, oz, amount)


@stage
def _find_facets(x, y, z, n, alpha, u, v, number, step_u, step_v, fx, fy, fz, ratios):
    for i in range(n):
        sine, cosine = sincos_turns(coordinate(u[i], number, step_u))
        height, ratios[i] = far_facet(coordinate(v[i], number, step_v))
        fx[i], fy[i], fz[i] = sample_visible_facet(x[i], y[i], z[i], alpha, cosine, sine, height)


@stage
def _refract(x, y, z, n, alpha, eta, fx, fy, fz, ratios, ratio, share, ox, oy, oz, amount):
    inverse_eta = 1.0 / eta
    for i in range(n):
        square = fx[i] * fx[i] + fy[i] * fy[i] + fz[i] * fz[i]
        cosine = max(0.0, x[i] * fx[i] + y[i] * fy[i] + z[i] * fz[i])
        transmittance, g = scaled_transmittance(cosine, square, eta)
        along_facet = (cosine - g) * inverse_eta
        along_view = inverse_eta * square
        # The new direction times the square.
        height = along_view * z[i] - along_facet * fz[i]
        g1, inverse = smith_g1_scaled(height, square, alpha)
        ox[i] = (along_view * x[i] - along_facet * fx[i]) * inverse
        oy[i] = (along_view * y[i] - along_facet * fy[i]) * inverse
        oz[i] = height * inverse
        amount[i] = transmittance * g1 * share * ratios[i] * ratio[i]
