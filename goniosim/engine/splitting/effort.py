"""How much is spent on light paths, where each of them walks for long: fewer branches, and fewer paths.

What enters a smooth coat at grazing angles is little light, and sees from inside the reflectance that it saw from
outside: with a share T let in, it leaves after 1 / T rounds. An analog ray is as long inside, but only a share T of
the rays gets there. So that what a path costs stays bounded, fewer paths are followed, each of which stands for more.

Light that is caught between inner interfaces is also little, and stays for long. There the branches are what takes
the time: a coin chooses one of them, before paths become fewer.

A few paths of a pilot tell what one costs. Where they walk on and on, their weights tell when they will end.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..layout import WEIGHT
from ..unit import BATCH, pilot_key
from .layout import EVENTS, STAGES
from .lobes import FEWER_LATER

# Batches in the fullest queue, above which inner interfaces do not branch. From there on no event adds
# rays, so that this, and what `unit.queue_capacity` says of such traffic, is all that a queue must hold.
CROWD = 3
# Rounds through the stack, of two events at every interface, that a path may take without becoming one of fewer.
ROUNDS = 32
# Paths of the pilot, its events between two looks at them, and stages after which it ends.
_PATHS = 64
_LOOK = 1 << 12
_STAGES = 1 << 16
# Smallest share, far below that of anything that leaves again.
_LEAST = 1e-12


@dataclass(frozen=True)
class Effort:
    """What is spent on the light paths of every direction.

    Attributes
    ----------
    crowds : ndarray of int64, shape (M,)
        Rays in the fullest queue, above which an inner interface does not branch: `CROWD` batches, or -1.
    followed : ndarray, shape (M,)
        Share of the paths that are followed, in (0, 1]; 1 where paths are short.
    """

    crowds: np.ndarray
    followed: np.ndarray

    @classmethod
    def unbounded(cls, directions):
        """Every path and every branch, but in a crowd."""
        return cls(np.full(directions, CROWD * BATCH), np.ones(directions))


def find_effort(plan, workspace):
    """What paths are worth that may be long.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    workspace : goniosim.engine.splitting.workspace.Workspace
        Knows facets and roulette; its effort is unbounded.

    Returns
    -------
    Effort
    """
    effort = Effort.unbounded(len(plan.theta_deg))
    for direction, facets in enumerate(workspace.facets):
        affordable = _PATHS * ROUNDS * (2 * len(plan.kinds) + facets.sum() / FEWER_LATER)
        events = _events(plan, workspace, direction, effort.crowds[direction])
        if events > affordable and len(plan.kinds) > 2:
            effort.crowds[direction] = -1
            events = _events(plan, workspace, direction, -1)
        if events > affordable:
            effort.followed[direction] = max(affordable / events, _LEAST)
    return effort


def _events(plan, workspace, direction, crowd):
    """Events of all paths of the pilot."""
    seen = []
    workspace.begin(_PATHS)
    while not workspace.advance(direction, pilot_key(direction), _LOOK, crowd):
        seen.append((int(workspace.state[EVENTS]), _light_inside(plan, workspace)))
        if workspace.state[STAGES] > _STAGES:
            return _extrapolated(*seen[len(seen) // 2], *seen[-1])
    return int(workspace.state[EVENTS])


def _light_inside(plan, workspace):
    """Sum of the largest weights of all rays that wait."""
    weights = workspace.queues[:, WEIGHT : WEIGHT + plan.n_distinct]
    return sum(float(each[:, :n].max(axis=0).sum()) for each, n in zip(weights, workspace.filled, strict=True))


def _extrapolated(middle, light_then, events, light):
    """Events until all is over, of paths whose light has decayed between the middle and the end of a pilot."""
    decay = math.log(max(light_then / light, 1.0)) / (events - middle) if light > 0.0 else 0.0
    # Roulette begins when a tenth of the light is left, and then takes as many rays as there is light lost.
    return events + (1.0 + math.log(10.0)) / max(decay, 1e-300)
