"""Masking of the scattered ray by the microsurface it leaves."""

from ..._jit import stage
from ..layout import GAIN, LOST_REFLECTION, LOST_TRANSMISSION, TRANSMITTED, WEIGHT


@stage
def apply_masking(batch, n, scratch, ledger):
    """Multiply all weights by the gain; book the rest as lost, by reflection or transmission."""
    gain = scratch[GAIN]
    transmitted = scratch[TRANSMITTED]
    for c in range(ledger.shape[1]):
        _mask_channel(batch[WEIGHT + c], n, gain, transmitted, ledger, c)


@stage
def _mask_channel(weight, n, gain, transmitted, ledger, c):
    lost = 0.0
    lost_in_transmission = 0.0
    for i in range(n):
        before = weight[i]
        after = before * gain[i]
        weight[i] = after
        masked = before - after
        lost += masked
        lost_in_transmission += masked * transmitted[i]
    ledger[LOST_TRANSMISSION, c] += lost_in_transmission
    ledger[LOST_REFLECTION, c] += lost - lost_in_transmission
