"""An estimator of replicates for tests: the analog walk, whose histograms are folded, all but their means forgotten."""

import numpy as np

from goniosim.engine.layout import DOWN, UP
from goniosim.engine.rounds import SMALLEST
from goniosim.engine.unit import Tally, Workspace


class Plain:
    """See `goniosim.engine.estimators`."""

    name = "plain"
    chunk = 3
    smallest = SMALLEST
    mends = False
    has_nodes = False

    def __init__(self, plan, sides=(UP, DOWN)):
        self.plan = plan
        self.sides = tuple(side for side in sides if plan.slots[side, 1] > 0)

    @staticmethod
    def refusal(plan, sides):
        """It serves every stack."""
        return None

    def prepare(self):
        """Nothing is shared."""

    def workspace(self):
        """Scratch arrays of one thread."""
        return _Space(self.plan, self.sides)


class _Space:
    def __init__(self, plan, sides):
        self.plan, self.sides = plan, sides
        self.walk, self.tally = Workspace(plan), Tally(plan)

    def run(self, direction, size, keys, out, stop):
        """Replicates of ``size`` rays."""
        plan, events = self.plan, 0
        for key, slices in zip(keys, out, strict=True):
            self.tally.clear()
            report = self.walk.run(direction, size, key, self.tally, stop)
            if report is None:
                return None
            events += report.events
            shape = (plan.n_slots, plan.rows, plan.columns, -1)
            energy = np.moveaxis(self.tally.histogram.reshape(shape)[..., : plan.n_distinct], -1, 1) / size
            chosen = np.concatenate([energy[slice(*self._slots(side))] for side in self.sides])
            slices[:] = (0.5 * (chosen + chosen[..., ::-1]))[..., : plan.width]
        return events

    def _slots(self, side):
        first, count, _ = (int(value) for value in self.plan.slots[side])
        return first, first + count
