"""Both ways on from a dielectric interface: each loop gives a direction and the share of the flux that goes there."""

from ..._jit import stage
from ...optics.ggx import smith_g1
from ..layout import X, Y, Z
from ..loops import reflect, share_out
from ..stages import ROUGH_DIELECTRIC
from .facets import draw_facets
from .layout import (
    BACK_GAIN,
    BACK_X,
    BACK_Y,
    BACK_Z,
    COSINE,
    COSINE_BEYOND,
    FACET_X,
    FACET_Y,
    FACET_Z,
    REFLECTANCE,
    THROUGH_GAIN,
    THROUGH_X,
    THROUGH_Y,
    THROUGH_Z,
)


@stage
def meet_dielectric(kind, batch, n, alpha, eta, scratch):
    """Choose facets of a rough interface, and find what they reflect; `facet_numbers` has drawn."""
    if kind == ROUGH_DIELECTRIC:
        cosines = scratch[COSINE]
        draw_facets(
            batch[X], batch[Y], batch[Z], n, alpha, scratch[FACET_X], scratch[FACET_Y], scratch[FACET_Z], cosines
        )
        share_out(cosines, n, eta, scratch[REFLECTANCE], scratch[COSINE_BEYOND])
    else:
        share_out(batch[Z], n, eta, scratch[REFLECTANCE], scratch[COSINE_BEYOND])


@stage
def go_through(kind, batch, n, alpha, eta, scratch):
    """The refracted rays."""
    x, y, z = batch[X], batch[Y], batch[Z]
    reflectance, beyond = scratch[REFLECTANCE], scratch[COSINE_BEYOND]
    ox, oy, oz, gain = scratch[THROUGH_X], scratch[THROUGH_Y], scratch[THROUGH_Z], scratch[THROUGH_GAIN]
    if kind == ROUGH_DIELECTRIC:
        fx, fy, fz, cosines = scratch[FACET_X], scratch[FACET_Y], scratch[FACET_Z], scratch[COSINE]
        _refract(x, y, z, n, alpha, eta, fx, fy, fz, cosines, reflectance, beyond, ox, oy, oz, gain)
    else:
        _refract_smooth(x, y, n, eta, reflectance, beyond, ox, oy, oz, gain)


@stage
def turn_back(kind, batch, n, alpha, scratch):
    """The reflected rays."""
    x, y, z = batch[X], batch[Y], batch[Z]
    reflectance = scratch[REFLECTANCE]
    ox, oy, oz, gain = scratch[BACK_X], scratch[BACK_Y], scratch[BACK_Z], scratch[BACK_GAIN]
    if kind == ROUGH_DIELECTRIC:
        fx, fy, fz, cosines = scratch[FACET_X], scratch[FACET_Y], scratch[FACET_Z], scratch[COSINE]
        reflect(x, y, z, n, alpha, fx, fy, fz, cosines, reflectance, ox, oy, oz, gain)
    else:
        _reflect_smooth(x, y, z, n, reflectance, ox, oy, oz, gain)


@stage
def _refract(x, y, z, n, alpha, eta, fx, fy, fz, cosines, reflectance, beyond, ox, oy, oz, gain):
    inverse_eta = 1.0 / eta
    for i in range(n):
        along_facet = cosines[i] * inverse_eta - beyond[i]
        height = inverse_eta * z[i] - along_facet * fz[i]
        ox[i] = inverse_eta * x[i] - along_facet * fx[i]
        oy[i] = inverse_eta * y[i] - along_facet * fy[i]
        oz[i] = height
        gain[i] = (1.0 - reflectance[i]) * smith_g1(height, alpha)


@stage
def _refract_smooth(x, y, n, eta, reflectance, beyond, ox, oy, oz, gain):
    inverse_eta = 1.0 / eta
    for i in range(n):
        ox[i] = inverse_eta * x[i]
        oy[i] = inverse_eta * y[i]
        oz[i] = beyond[i]
        gain[i] = 1.0 - reflectance[i]


@stage
def _reflect_smooth(x, y, z, n, reflectance, ox, oy, oz, gain):
    for i in range(n):
        ox[i] = x[i]
        oy[i] = y[i]
        oz[i] = z[i]
        gain[i] = reflectance[i]
