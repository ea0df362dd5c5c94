"""What happens to rays between two interfaces: absorption, and Russian roulette on faint rays."""

from ..._jit import stage
from ...optics.random import derive_key, uniform
from ..layout import ABSORBED_MEDIA, LOST_ROULETTE, WEIGHT, Z
from ..loops import attenuations, path_lengths

# Which child of the stage's key decides the roulette.
ROULETTE = 3


@stage
def absorb(batch, n, tau, path, fraction, ledger):
    """Attenuate ``n`` rays that have crossed a medium of optical depths ``tau[channel]``.

    ``path`` and ``fraction`` are overwritten: the lengths of the ways, in units of the layer's depth, and
    what was left of the last channel that was attenuated.
    """
    path_lengths(batch[Z], n, path)
    known = 0.0
    for c in range(tau.shape[0]):
        if tau[c] > 0.0:
            # Neighbouring channels are often alike, and the exponential is what takes time.
            if tau[c] != known:
                attenuations(n, tau[c], path, fraction)
                known = tau[c]
            ledger[ABSORBED_MEDIA, c] += _rescale(batch[WEIGHT + c], n, fraction)


@stage
def roulette(batch, n, scale, brightness, key, ledger):
    """Play Russian roulette with the faint ones among ``n`` rays; the losers' weights become 0.

    ``scale`` holds for each channel the reciprocal of the weight below which a ray is faint. A ray
    that is so in every channel survives with a probability that restores it to where it is not. The
    mean is untouched; the loop stops following rays that no cell would notice. Returns whether any
    ray was faint; ``brightness`` is overwritten.
    """
    if not _any_faint(batch, n, scale, brightness):
        return False
    roulette_key = derive_key(key, ROULETTE)
    for i in range(n):
        bright = brightness[i]
        boost = 1.0 / max(bright, 1e-300) if uniform(roulette_key, i) < bright else 0.0
        brightness[i] = boost if bright < 1.0 else 1.0
    for c in range(scale.shape[0]):
        ledger[LOST_ROULETTE, c] += _rescale(batch[WEIGHT + c], n, brightness)
    return True


@stage
def _any_faint(batch, n, scale, brightness):
    weight = batch[WEIGHT]
    unit = scale[0]
    for i in range(n):
        brightness[i] = weight[i] * unit
    for c in range(1, scale.shape[0]):
        weight = batch[WEIGHT + c]
        unit = scale[c]
        for i in range(n):
            brightness[i] = max(brightness[i], weight[i] * unit)
    faint = 0
    for i in range(n):
        faint += 1 if brightness[i] < 1.0 else 0
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
