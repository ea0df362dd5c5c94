"""The split walk as an estimator: it serves every stack, and is what is left where nothing faster applies."""

import math
from dataclasses import replace

import numpy as np

from ..rounds import SMALLEST
from ..splitting.effort import Effort, find_effort
from ..splitting.layout import LATER, PHASES
from ..splitting.lobes import MOST_FACETS, facets_per_arrival
from ..splitting.usual import usual_weights
from ..splitting.workspace import Workspace, shapes
from ..unit import DARKEST
from ..walk import ABOVE, BELOW

# A ray that is fainter than this, relative to what is usual at its place, plays Russian roulette. Where inner
# interfaces branch, their dim branches carry what is rare: those are followed further.
_FAINT = 0.5
_FAINT_BRANCH = 0.2
# And so is light that comes by again: it costs few facets.
_FAINT_LATER = 0.1
# Facets for each one of the other way out.
_MOST_BESIDE = 8
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
    smallest = SMALLEST
    mends = True
    has_nodes = False

    @staticmethod
    def refusal(plan, sides):
        """It applies to everything: None."""
        return None

    @classmethod
    def tiny(cls, plan, sides):
        """One that runs the same kernels."""
        return cls(replace(plan, theta_deg=plan.theta_deg[:1], light=plan.light[:1], rows=2, columns=4), sides)

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
        # Or paths would be too few for the way out that tells one thing of each.
        fewest = np.min(self.facets, axis=1, where=self.facets > 0, initial=MOST_FACETS)
        self.facets = np.minimum(self.facets, _MOST_BESIDE * fewest[:, None])
        self.scales = None
        self.effort = Effort.unbounded(len(directions))

    def prepare(self):
        """Find out which weights are usual; the pilot's keys are its own."""
        plan = self.plan
        queues = 2 * len(plan.kinds)
        shape = (len(plan.theta_deg), PHASES * queues, plan.n_distinct)
        self.scales = np.full(shape, 1.0 / DARKEST)
        usual = usual_weights(plan, self.workspace())
        faint = np.full(PHASES * queues, _FAINT if len(plan.kinds) < 3 else _FAINT_BRANCH)
        faint[LATER * queues :] = _FAINT_LATER
        self.scales = 1.0 / np.maximum(faint[:, None] * usual, DARKEST)
        self._share_facets(usual.max(axis=-1))
        self.effort = find_effort(plan, self.workspace())

    def _share_facets(self, usual):
        """Fewer facets for the dimmer one of two ways out, by the root of what is usual there, shape (M, queues)."""
        last = len(self.plan.kinds) - 1
        up, down = (usual.reshape(len(usual), PHASES, -1)[:, :, q].max(axis=1) for q in (BELOW, 2 * last + ABOVE))
        asked = np.where(self.facets > 0, np.stack([up, down], axis=1), 0.0)
        share = np.sqrt(asked / np.maximum(asked.max(axis=1, keepdims=True), DARKEST))
        self.facets = np.maximum((self.facets * share).astype(np.int64), np.minimum(self.facets, 1))

    @property
    def memory(self):
        """Bytes that all threads share, and bytes of a workspace."""
        numbers = sum(math.prod(shape) for shape in shapes(self.plan, int(self.slots[:, 1].sum())).values())
        return 0, _NUMBER * numbers

    def workspace(self):
        """Arrays of one thread, with ``run``."""
        return Workspace(self.plan, self.slots, self.facets, self.scales, self.effort)
