"""Perfectly smooth opaque conductor: Fresnel reflectance per channel, mirror direction."""

from ..._jit import stage
from ...optics.fresnel import conductor_absorptance, fresnel_conductor
from ..layout import ABSORBED_BASE, GAIN, TRANSMITTED, WEIGHT, Z

ETA, KAPPA = 0, 1


def lower(interface, index_above):
    """Width, and relative eta and kappa; see `goniosim.engine.stages.lower`."""
    eta = [value / index_above for value in interface.eta_rgb]
    kappa = [value / index_above for value in interface.kappa_rgb]
    return interface.alpha, 1.0, [eta, kappa]


@stage
def scatter(batch, n, spectral, scratch, ledger):
    """Scatter ``n`` rays; ``spectral`` holds the relative eta and kappa of every channel."""
    gain = scratch[GAIN]
    transmitted = scratch[TRANSMITTED]
    for i in range(n):
        gain[i] = 1.0
        transmitted[i] = 0.0
    absorb_in_conductor(batch, n, spectral, batch[Z], ledger)


@stage
def absorb_in_conductor(batch, n, spectral, cosines, ledger):
    """Multiply the weights by the Fresnel reflectance and book what is absorbed."""
    for c in range(spectral.shape[1]):
        eta = spectral[ETA, c]
        kappa = spectral[KAPPA, c]
        weight = batch[WEIGHT + c]
        absorbed = 0.0
        for i in range(n):
            before = weight[i]
            weight[i] = before * fresnel_conductor(cosines[i], eta, kappa)
            # Not the difference of the weights, which has no digits left for a good mirror.
            absorbed += before * conductor_absorptance(cosines[i], eta, kappa)
        ledger[ABSORBED_BASE, c] += absorbed
