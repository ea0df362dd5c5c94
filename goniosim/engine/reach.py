"""How much light can leave a stack one way at all: what a run that saw nothing may take for nothing."""

import math

import numpy as np

from .layout import DOWN, UP
from .stages import LAMBERT, OPAQUE, ROUGH_CONDUCTOR, SMOOTH_CONDUCTOR, SMOOTH_DIELECTRIC
from .stages.lambert import RHO

# Of products of indices, so that nothing is taken for totally reflected that might just pass.
ROUNDING = 1e-13


def most_light(plan, side, direction):
    """Share of the light of a direction that leaves one way, at the most.

    A bound and no estimate: interfaces let all pass and reflect all that they do not absorb for sure, and beyond the
    first rough one light takes the shortest way.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    side : int
        `layout.UP`, for what has been inside, or `layout.DOWN`.
    direction : int

    Returns
    -------
    float
        Of the brightest channel; 0 only where it is certain that no light leaves that way, as numbers go.
    """
    found, inwards, outwards = (np.zeros(plan.n_distinct) for _ in range(3))
    index, is_straight = 1.0, True
    for k, kind in enumerate(plan.kinds):
        if side == UP and k > 0:
            # What turns back here has crossed all media above twice.
            found += _reflected(plan, k) * np.exp(-(inwards + outwards))
        if kind in OPAQUE:
            break
        index *= plan.etas[k]
        is_straight &= bool(kind == SMOOTH_DIELECTRIC)
        cosine = _cosine(plan.light[direction, 2], index) if is_straight else 1.0
        if cosine == 0.0:
            break
        if k < len(plan.kinds) - 1:
            # The deepest media are as good as infinitely deep.
            with np.errstate(over="ignore"):
                inwards += plan.taus[k] / cosine
                outwards += plan.taus[k]
        elif side == DOWN:
            found = np.exp(-inwards)
    return float(min(found.max(), 1.0))


def _cosine(height, index):
    """At most the cosine in a medium below smooth interfaces; 0 if light of such a height cannot get there."""
    square = height * height + (index - 1.0) * (index + 1.0) + ROUNDING
    return min(math.sqrt(max(square, 0.0)) / index, 1.0)


def _reflected(plan, k):
    """What an interface reflects at the most, by channel."""
    kind = plan.kinds[k]
    if kind == LAMBERT:
        return plan.spectral[k, RHO]
    if kind in (SMOOTH_CONDUCTOR, ROUGH_CONDUCTOR):
        return np.where(plan.blacks[k], 0.0, 1.0)
    return np.full(plan.n_distinct, float(plan.etas[k] != 1.0))
