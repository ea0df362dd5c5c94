"""Lambertian base: reflects rho, in a direction that has forgotten where the ray came from."""

from ..._jit import stage
from ...optics.lambert import cosine_direction
from ...optics.random import derive_key, random_sincos, uniform
from ..layout import ABSORBED_BASE, GAIN, TRANSMITTED, WEIGHT, X, Y, Z

RHO = 0


def lower(interface, index_above):
    """Reflectance rho; see `goniosim.engine.stages.lower`."""
    return 0.0, 1.0, [interface.rho_rgb]


@stage
def scatter(batch, n, spectral, key, scratch, ledger):
    """Scatter ``n`` rays; ``spectral`` holds the reflectance rho of every channel."""
    _sample(batch[X], batch[Y], batch[Z], n, key, scratch[GAIN], scratch[TRANSMITTED])
    for c in range(spectral.shape[1]):
        rho = spectral[RHO, c]
        weight = batch[WEIGHT + c]
        absorbed = 0.0
        for i in range(n):
            before = weight[i]
            after = before * rho
            weight[i] = after
            absorbed += before - after
        ledger[ABSORBED_BASE, c] += absorbed


@stage
def _sample(x, y, z, n, key, gain, transmitted):
    height_key = derive_key(key, 0)
    azimuth_key = derive_key(key, 1)
    for i in range(n):
        sine, cosine = random_sincos(azimuth_key, i)
        x[i], y[i], z[i] = cosine_direction(uniform(height_key, i), cosine, sine)
        gain[i] = 1.0
        transmitted[i] = 0.0
