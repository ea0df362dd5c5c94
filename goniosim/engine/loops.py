"""Loops over the rows of a batch that several walks share."""

from .._jit import stage
from ..optics.fresnel import fresnel_conductor, fresnel_dielectric
from ..optics.ggx import smith_g1
from ..optics.medium import path_length, transmittance


@stage
def path_lengths(cosines, n, path):
    """Ways through a layer, in units of its depth."""
    for i in range(n):
        path[i] = path_length(cosines[i])


@stage
def attenuations(n, tau, path, fraction):
    """What is left after these ways at an optical depth."""
    for i in range(n):
        fraction[i] = transmittance(tau, path[i])


@stage
def multiply(values, n, factors):
    """Multiply ``n`` values by factors."""
    for i in range(n):
        values[i] *= factors[i]


@stage
def scale(values, n, factor):
    """Multiply ``n`` values by a number."""
    for i in range(n):
        values[i] *= factor


@stage
def colour(weight, n, cosines, eta, kappa):
    """What a conductor reflects."""
    for i in range(n):
        weight[i] *= fresnel_conductor(cosines[i], eta, kappa)


@stage
def share_out(cosines, n, eta, reflectance, beyond):
    """What a dielectric reflects, and the cosine of the refracted ray."""
    for i in range(n):
        reflectance[i], beyond[i] = fresnel_dielectric(cosines[i], eta)


@stage
def reflect(x, y, z, n, alpha, fx, fy, fz, cosines, reflectance, ox, oy, oz, gain):
    """The rays that facets reflect, and their share after masking."""
    for i in range(n):
        twice = 2.0 * cosines[i]
        height = twice * fz[i] - z[i]
        ox[i] = x[i] - twice * fx[i]
        oy[i] = y[i] - twice * fy[i]
        oz[i] = height
        gain[i] = reflectance[i] * smith_g1(height, alpha)
