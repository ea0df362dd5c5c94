"""What happens to rays between two interfaces: absorption, and Russian roulette on faint rays."""

from ..._jit import stage
from ...optics.medium import path_length, transmittance
from ...optics.random import derive_key, uniform
from ..layout import ABSORBED_MEDIA, LOST_ROULETTE, WEIGHT, Z

# A ray fainter than this in every channel survives with a probability that restores it to this
# weight. The mean is untouched; the loop stops following rays that no cell would notice.
ROULETTE_WEIGHT = 1e-3
# Which child of the stage's key decides the roulette.
ROULETTE = 3


@stage
def absorb(batch, n, tau, path, ledger):
    """Attenuate ``n`` rays that have crossed a medium of optical depths ``tau[channel]``.

    ``path`` is overwritten: the lengths of the ways, in units of the layer's depth.
    """
    _path_lengths(batch[Z], n, path)
    for c in range(tau.shape[0]):
        if tau[c] > 0.0:
            ledger[ABSORBED_MEDIA, c] += _absorb_channel(batch[WEIGHT + c], n, tau[c], path)


@stage
def _path_lengths(cosines, n, path):
    for i in range(n):
        path[i] = path_length(cosines[i])


@stage
def _absorb_channel(weight, n, tau, path):
    absorbed = 0.0
    for i in range(n):
        before = weight[i]
        after = before * transmittance(tau, path[i])
        weight[i] = after
        absorbed += before - after
    return absorbed


@stage
def roulette(batch, n, channels, brightest, key, ledger):
    """Play Russian roulette with the faint ones among ``n`` rays; the losers' weights become 0.

    Returns whether any ray was faint; ``brightest`` is overwritten.
    """
    if not _any_faint(batch, n, channels, brightest):
        return False
    roulette_key = derive_key(key, ROULETTE)
    for i in range(n):
        bright = brightest[i]
        survives = uniform(roulette_key, i) * ROULETTE_WEIGHT < bright
        boost = ROULETTE_WEIGHT / max(bright, 1e-300) if survives else 0.0
        brightest[i] = boost if bright < ROULETTE_WEIGHT else 1.0
    for c in range(channels):
        ledger[LOST_ROULETTE, c] += _rescale(batch[WEIGHT + c], n, brightest)
    return True


@stage
def _any_faint(batch, n, channels, brightest):
    weight = batch[WEIGHT]
    for i in range(n):
        brightest[i] = weight[i]
    for c in range(1, channels):
        weight = batch[WEIGHT + c]
        for i in range(n):
            brightest[i] = max(brightest[i], weight[i])
    faint = 0
    for i in range(n):
        faint += 1 if brightest[i] < ROULETTE_WEIGHT else 0
    return faint > 0


@stage
def _rescale(weight, n, factor):
    lost = 0.0
    for i in range(n):
        before = weight[i]
        after = before * factor[i]
        weight[i] = after
        lost += before - after
    return lost


@stage
def drop_dead(gain, n, factor):
    """Zero the gain of the rays whose roulette ``factor`` is zero."""
    for i in range(n):
        gain[i] = gain[i] if factor[i] > 0.0 else 0.0
