"""Perfectly smooth dielectric interface: Fresnel coin, mirror direction or Snell's law."""

from ..._jit import stage
from ...optics.fresnel import reflects
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
        reflect, g = reflects(uniform(coin_key, i), cosine, 1.0, eta)
        # The view vector at the next interface keeps its horizontal direction, as the ray does.
        scale = 1.0 if reflect else inverse_eta
        x[i] *= scale
        y[i] *= scale
        z[i] = cosine if reflect else g * inverse_eta
        gain[i] = 1.0
        transmitted[i] = 0.0 if reflect else 1.0
