"""Perfectly smooth dielectric interface: Fresnel coin, mirror direction or Snell's law."""

from ..._jit import stage
from ...optics.fresnel import fresnel_dielectric
from ...optics.random import derive_key, uniform
from ..layout import GAIN, TRANSMITTED, X, Y, Z

# Which child of the stage's key decides between reflection and refraction.
COIN = 2


def lower(interface, index_above):
    """Width, relative index; see `goniosim.engine.stages.lower`."""
    return interface.alpha, interface.eta / index_above, []


@stage
def scatter(batch, n, eta, key, scratch):
    """Scatter ``n`` rays; ``eta`` is the index of the far side relative to the side of arrival."""
    x = batch[X]
    y = batch[Y]
    z = batch[Z]
    gain = scratch[GAIN]
    transmitted = scratch[TRANSMITTED]
    coin_key = derive_key(key, COIN)
    inverse_eta = 1.0 / eta
    for i in range(n):
        cosine = z[i]
        reflectance, cos_t = fresnel_dielectric(cosine, eta)
        reflect = uniform(coin_key, i) < reflectance
        # The view vector at the next interface keeps its horizontal direction, as the ray does.
        scale = 1.0 if reflect else inverse_eta
        x[i] *= scale
        y[i] *= scale
        z[i] = cosine if reflect else cos_t
        gain[i] = 1.0
        transmitted[i] = 0.0 if reflect else 1.0
