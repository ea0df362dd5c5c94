"""At which interface an operator is applied, and what becomes of the light that leaves it: by widths alone."""

from dataclasses import dataclass

import numpy as np

from ..layout import DOWN, UP
from ..stages import ROUGH_CONDUCTOR, ROUGH_DIELECTRIC

# What a ray from inside refracts into is alpha |1 - 1/n| wide: at least two nodes, that of width .05 at n = 1.5.
WIDE_LOBE = 0.0166
# Below that, nodes half a degree apart leave a bias of the size of the noise of 10^8 paths.
FINE_LOBE = 2.0 * WIDE_LOBE
# Near n = 1 the lobe of a fixed exit has far tails besides, which no width of the core tells.
LEAST_CONTRAST = 0.15
# A reflected lobe is wider. Above NARROW the exit's own operator is as good, and cheaper.
WIDE_REFLECTION = 0.05
NARROW = 0.1
# Towards grazing a reflected lobe varies faster than the nodes are apart: at 75 degrees one of width .05 does not yet.
MOST_SINE = 0.966

# What the light does after its last arrival at the interface: leave; or be reflected towards the exit, which is then
# sampled from the cells, or is wide and an operator too.
OUT, IN, THROUGH = "out", "in", "through"


@dataclass(frozen=True)
class Variant:
    """Where an operator is applied.

    Attributes
    ----------
    interface : int
    exit : int
        The interface through which the light leaves; for `OUT` the same.
    leaves : str
        `OUT`, `IN` or `THROUGH`.
    from_below : bool
        The side of ``interface`` at which the light arrives.
    """

    interface: int
    exit: int
    leaves: str
    from_below: bool

    @property
    def sees_light(self):
        """Whether light that has met nothing but the interface leaves it towards the exit, besides the arrivals."""
        return self.leaves == IN and self.interface == 0


def inner_index(plan, interface):
    """Index inside the stack over outside, of its first or last interface."""
    return float(plan.etas[0]) if interface == 0 else 1.0 / float(plan.etas[-1])


def choose(plan, side):
    """The variant for a way out, or one sentence why there is none."""
    last = len(plan.kinds) - 1
    if plan.slots[side, 1] == 0:
        return "no light leaves this way"
    leaving = 0 if side == UP else last
    other = last - leaving
    wide = _transmits_widely(plan, leaving)
    if last == 0:
        return "operators take light that has been inside, and there is a single interface"
    if last == 1 and side == UP and _graze(plan) and _reflects_widely(plan, other) and not wide:
        return "light arrives at the base at grazing angles, where nodes are too far apart"
    reflects = last == 1 and side == UP and not _graze(plan) and _reflects_widely(plan, other)
    if reflects and plan.alphas[leaving] < NARROW:
        return Variant(other, leaving, THROUGH if wide else IN, from_below=False)
    if wide:
        return Variant(leaving, leaving, OUT, from_below=side == UP)
    # The light itself refracts into the same lobe as rays from inside.
    if last == 1 and side == DOWN and _transmits_widely(plan, other):
        return Variant(other, leaving, IN, from_below=True)
    return (
        f"the {'top' if side == UP else 'last'} interface refracts into a lobe narrower than {WIDE_LOBE} "
        f"or has an index within {LEAST_CONTRAST:.0%} of its neighbour's"
        + (", and the other interface is narrow as well" if last == 1 else "")
    )


def finer(plan, variant):
    """How many times as many polar angles arrivals need as all else has: the exit's lobes are narrowest in them."""
    return 2 if variant.leaves == OUT and _width(plan, variant.exit) < FINE_LOBE else 1


def _graze(plan):
    """Whether some light that is refracted by the mean top interface meets the next one at a grazing angle."""
    return bool((plan.light[:, 0] > MOST_SINE * float(plan.etas[0])).any())


def _transmits_widely(plan, interface):
    rough = plan.kinds[interface] == ROUGH_DIELECTRIC
    return bool(rough and _width(plan, interface) >= WIDE_LOBE and _contrast(plan, interface) > LEAST_CONTRAST)


def _contrast(plan, interface):
    return np.abs(1.0 - 1.0 / inner_index(plan, interface))


def _width(plan, interface):
    """Of what a ray from inside refracts into."""
    return plan.alphas[interface] * _contrast(plan, interface)


def _reflects_widely(plan, interface):
    rough = plan.kinds[interface] in (ROUGH_DIELECTRIC, ROUGH_CONDUCTOR)
    return bool(rough and plan.alphas[interface] >= WIDE_REFLECTION)
