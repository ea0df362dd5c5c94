"""The split walk as an estimator: it serves every stack, and is what is left where nothing faster applies."""

import math
from dataclasses import replace

import numpy as np

from ..splitting.layout import PHASES
from ..splitting.lobes import MOST_FACETS, facets_per_arrival
from ..splitting.usual import usual_weights
from ..splitting.workspace import Workspace, shapes
from ..unit import DARKEST

# A ray that is fainter than this, relative to what is usual at its place, plays Russian roulette. Where inner
# interfaces branch, their dim branches carry what is rare: those are followed further.
_FAINT = 0.5
_FAINT_BRANCH = 0.2
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

    def prepare(self):
        """Find out which weights are usual; the pilot's keys are its own."""
        plan = self.plan
        faint = _FAINT if len(plan.kinds) < 3 else _FAINT_BRANCH
        shape = (len(plan.theta_deg), PHASES * 2 * len(plan.kinds), plan.n_distinct)
        self.scales = np.full(shape, 1.0 / DARKEST)
        self.scales = 1.0 / np.maximum(faint * usual_weights(plan, self.workspace()), DARKEST)

    @property
    def memory(self):
        """Bytes that all threads share, and bytes of a workspace."""
        numbers = sum(math.prod(shape) for shape in shapes(self.plan, int(self.slots[:, 1].sum())).values())
        return 0, _NUMBER * numbers

    def workspace(self):
        """Arrays of one thread, with ``run``."""
        return Workspace(self.plan, self.slots, self.facets, self.scales)
