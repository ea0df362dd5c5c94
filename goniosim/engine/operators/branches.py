"""What an interface does to a batch: its losses, and the directions and shares of both ways on."""

from ..._jit import stage
from ...optics.fresnel import dielectric_transmittance, fresnel_dielectric
from ...optics.ggx import smith_g1
from ...optics.lambert import cosine_direction
from ..loops import attenuations, multiply, path_lengths, reflect
from .rays import (
    COSINE,
    COSINE_BEYOND,
    FACET_X,
    FACET_Y,
    FACET_Z,
    FRACTION,
    GAIN,
    NEXT_X,
    NEXT_Y,
    NEXT_Z,
    PATH,
    REFLECTANCE,
    WEIGHT,
    X,
    Y,
    Z,
)


@stage
def absorb(batch, n, tau, scratch):
    """Attenuate ``n`` rays that have crossed a medium of optical depths ``tau[channel]``."""
    path_lengths(batch[Z], n, scratch[PATH])
    known = 0.0
    for c in range(tau.shape[0]):
        if tau[c] > 0.0:
            # Neighbouring channels are often alike, and the exponential is what takes time.
            if tau[c] != known:
                attenuations(n, tau[c], scratch[PATH], scratch[FRACTION])
                known = tau[c]
            multiply(batch[WEIGHT + c], n, scratch[FRACTION])


@stage
def find_brightest(batch, n, channels, brightest):
    """The largest weight of each ray."""
    weight = batch[WEIGHT]
    for i in range(n):
        brightest[i] = weight[i]
    for c in range(1, channels):
        weight = batch[WEIGHT + c]
        for i in range(n):
            brightest[i] = max(brightest[i], weight[i])


@stage
def enter(light, n, alpha, eta, scratch):
    """Refract light into the stack, as the next interface views it; all of it enters."""
    _enter(
        light[0],
        light[2],
        n,
        alpha,
        eta,
        scratch[FACET_X],
        scratch[FACET_Y],
        scratch[FACET_Z],
        scratch[COSINE],
        scratch[NEXT_X],
        scratch[NEXT_Y],
        scratch[NEXT_Z],
        scratch[GAIN],
    )


@stage
def _enter(x, z, n, alpha, eta, fx, fy, fz, cosines, ox, oy, oz, gain):
    for i in range(n):
        cosine = cosines[i]
        _, beyond = fresnel_dielectric(cosine, eta)
        along = cosine / eta - beyond
        height = z / eta - along * fz[i]
        ox[i] = x / eta - along * fx[i]
        oy[i] = -along * fy[i]
        oz[i] = height
        gain[i] = dielectric_transmittance(cosine, eta) * smith_g1(height, alpha)


@stage
def turn_back(batch, n, alpha, scratch):
    """The reflected rays, and their share."""
    reflect(
        batch[X],
        batch[Y],
        batch[Z],
        n,
        alpha,
        scratch[FACET_X],
        scratch[FACET_Y],
        scratch[FACET_Z],
        scratch[COSINE],
        scratch[REFLECTANCE],
        scratch[NEXT_X],
        scratch[NEXT_Y],
        scratch[NEXT_Z],
        scratch[GAIN],
    )


@stage
def go_through(batch, n, alpha, eta, scratch):
    """The refracted rays, and their share."""
    _refract(
        batch[X],
        batch[Y],
        batch[Z],
        n,
        alpha,
        eta,
        scratch[FACET_X],
        scratch[FACET_Y],
        scratch[FACET_Z],
        scratch[COSINE],
        scratch[REFLECTANCE],
        scratch[COSINE_BEYOND],
        scratch[NEXT_X],
        scratch[NEXT_Y],
        scratch[NEXT_Z],
        scratch[GAIN],
    )


@stage
def _refract(x, y, z, n, alpha, eta, fx, fy, fz, cosines, reflectance, beyond, ox, oy, oz, gain):
    inverse = 1.0 / eta
    for i in range(n):
        along = cosines[i] * inverse - beyond[i]
        height = z[i] * inverse - along * fz[i]
        ox[i] = x[i] * inverse - along * fx[i]
        oy[i] = y[i] * inverse - along * fy[i]
        oz[i] = height
        gain[i] = (1.0 - reflectance[i]) * smith_g1(height, alpha)


@stage
def forget(n, cosines, sines, heights, ox, oy, oz, gain):
    """Rays that a Lambertian base sends back."""
    for i in range(n):
        ox[i], oy[i], oz[i] = cosine_direction(heights[i], cosines[i], sines[i])
        gain[i] = 1.0
