"""How many of the light paths are worth following, where each of them walks for long.

What enters a smooth coat at grazing angles is little light, and sees from inside the reflectance that it saw from
outside: with a share T let in, it leaves after 1 / T rounds. An analog ray is as long inside, but only a share T of
the rays gets there. So that what a path costs stays bounded, fewer paths are followed, each of which stands for more.

A few paths of a pilot tell what one costs. Where they walk on and on, their weights tell when they will end.
"""

import math

import numpy as np

from ..layout import WEIGHT
from ..unit import pilot_key
from .layout import EVENTS, STAGES
from .lobes import FEWER_LATER

# Rounds through the stack, of two events at every interface, that a path may take without becoming one of fewer.
ROUNDS = 32
# Paths of the pilot, its events between two looks at them, and stages after which it ends.
_PATHS = 64
_LOOK = 1 << 12
_STAGES = 1 << 16
# Smallest share, far below that of anything that leaves again.
_LEAST = 1e-12


def shares_followed(plan, workspace):
    """Shares of the light paths that are to be followed.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    workspace : goniosim.engine.splitting.workspace.Workspace
        Knows facets and roulette; follows every path.

    Returns
    -------
    ndarray, shape (M,)
        In (0, 1]; 1 where paths are short.
    """
    return np.array([_share(plan, workspace, direction) for direction in range(len(plan.theta_deg))])


def _share(plan, workspace, direction):
    facets = int(workspace.facets[direction].sum())
    affordable = ROUNDS * (2 * len(plan.kinds) + facets / FEWER_LATER)
    return float(np.clip(affordable * _PATHS / max(_events(plan, workspace, direction), 1), _LEAST, 1.0))


def _events(plan, workspace, direction):
    """Events of all paths of the pilot."""
    seen = []
    workspace.begin(_PATHS)
    while not workspace.advance(direction, pilot_key(direction), _LOOK):
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
