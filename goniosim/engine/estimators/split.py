"""The split walk as an estimator: it serves every stack, and is what is left where nothing faster applies."""

import math

import numpy as np

from ..faint import usual_weights
from ..layout import WEIGHT
from ..splitting.lobes import facets_per_arrival
from ..splitting.workspace import Workspace, shapes
from ..unit import BATCH, DARKEST, pilot_key
from ..walk import ABOVE

# A ray that is fainter than this, relative to what is usual at its place, plays Russian roulette. Where inner
# interfaces branch, their dim branches carry what is rare: those are followed further.
_FAINT = 1.0
_FAINT_BRANCH = 0.1
# Bytes of a number.
_NUMBER = 8


class Split:
    """See `goniosim.engine.estimators`.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    sides : tuple of int
        Ways out that are asked for, of UP and DOWN.
    """

    name = "split"
    chunk = 1
    mends = True
    has_nodes = False

    @staticmethod
    def refusal(plan, sides):
        """It applies to everything: None."""
        return None

    def __init__(self, plan, sides):
        self.plan = plan
        self.slots = np.zeros((2, 3), np.int64)
        first = 0
        for side in sides:
            _, count, first_order = plan.slots[side]
            self.slots[side] = first, count, first_order
            first += count
        directions = range(len(plan.theta_deg))
        self.facets = np.zeros((len(directions), 2), np.int64)
        for side in sides:
            self.facets[:, side] = [facets_per_arrival(plan, direction, side) for direction in directions]
        self.scales = None

    def prepare(self):
        """Find out which weights are usual; the pilot's keys are its own."""
        plan = self.plan
        usual = usual_weights(plan)
        faint = _FAINT if len(plan.kinds) < 3 else _FAINT_BRANCH
        self.scales = np.ones_like(usual)
        workspace = self.workspace()
        entered = [_entered(workspace, direction) for direction in range(len(usual))]
        self.scales = 1.0 / np.maximum(faint * np.array(entered)[:, None, None] * usual, DARKEST)

    @property
    def memory(self):
        """Bytes that all threads share, and bytes of a workspace."""
        numbers = sum(math.prod(shape) for shape in shapes(self.plan, int(self.slots[:, 1].sum())).values())
        return 0, _NUMBER * numbers

    def workspace(self):
        """Arrays of one thread, with ``run``."""
        return Workspace(self.plan, self.slots, self.facets, self.scales)


def _entered(workspace, direction):
    """Mean weight of the rays that enter the stack, as far as any do: no coin has been tossed for them."""
    if len(workspace.plan.kinds) == 1:
        return 1.0
    workspace.begin(BATCH)
    workspace.advance(direction, pilot_key(direction), 1)
    queue = 2 + ABOVE
    weights = workspace.queues[queue, WEIGHT, : workspace.filled[queue]]
    return weights.mean() if len(weights) else 1.0
