"""The analog estimator: every ray is a path of its own that leaves once, and tells its own error."""

import time

import numpy as np

from ..sums import Paths, sum_and_error
from .estimate import Estimate, mean_and_error, moments
from .faint import faint_weights
from .layout import N_LEDGER
from .packing import array
from .runs import Spending, Work
from .schedule import MOST_LEDGERS, Schedule
from .unit import Tally, Workspace, unit_key

# Rays of a direction in the first round of a run that stops at an accuracy.
FIRST_ROUND = 1 << 17


class AnalogRun:
    """Slices and energy balances of all ways out.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    key : int or uint64
        Seed of the random numbers.
    sides : tuple of int
        Ways out that it is asked for.

    Attributes
    ----------
    tallies : list of goniosim.engine.unit.Tally
        Of each direction, over the work units that are through.
    ledgers, part_rays : list of list
        Energy balances of the parts of the work units of each direction, and their rays.
    spending : goniosim.engine.runs.Spending
    """

    name = "analog"
    # Its rays are followed to their ends, so that it tells where all energy went.
    audits = True
    # Pieces that wait for their turn, for each thread: its pieces are alike.
    waiting = 1

    def __init__(self, plan, key, sides=()):
        directions = len(plan.theta_deg)
        self.sides = sides
        self._plan, self._key = plan, key
        self._faint = None
        self.tallies = [Tally(plan) for _ in range(directions)]
        self._units = [0] * directions
        self._issued = [0] * directions
        self.ledgers = [[] for _ in range(directions)]
        self.part_rays = [[] for _ in range(directions)]
        self.spending = Spending(directions)

    @property
    def rays(self):
        """Rays that are through, of each direction."""
        return [sum(sizes) for sizes in self.part_rays]

    @property
    def finished(self):
        """Whether all rays are through that were handed out."""
        return self._units == self._issued

    def prepare(self):
        """Look up what is faint."""
        start = time.thread_time()
        self._faint = faint_weights(self._plan)
        self.spending.share(time.thread_time() - start)

    @property
    def gathered(self):
        """Whether there is something to keep."""
        return any(self._units)

    def rounds(self, rays):
        """Work units of so many rays of each direction, in a single round: lists of Work."""
        return [self._works(rays, range(len(self.tallies)))]

    def _works(self, rays, chosen):
        schedule = Schedule(len(chosen), rays)
        checkpoints = set(schedule.checkpoints)
        made = []
        for direction, unit, share in map(schedule.__getitem__, range(len(schedule))):
            m = chosen[direction]
            made.append(Work(m, self._issued[m], share, last=unit + 1 in checkpoints))
            self._issued[m] += 1
        return made

    def rays_of_round(self, number):
        """Rays of a direction in a round of a run that stops at an accuracy: each doubles what there is."""
        return FIRST_ROUND << max(0, number - 1)

    def round(self, number, directions):
        """Work units of such a round."""
        return self._works(self.rays_of_round(number), directions)

    def buffer(self):
        """What a piece of work fills."""
        return Tally(self._plan)

    def workspace(self):
        """Scratch arrays of one thread."""
        return Workspace(self._plan, self._faint)

    def work(self, work, tally, workspace, stop):
        """Trace a work unit into a tally; returns its report, None if it was given up."""
        key = unit_key(self._key, work.direction, work.number)
        return workspace.run(work.direction, work.rays, key, tally, stop)

    def reduce(self, work, report, tally):
        """Add up a work unit."""
        direction = work.direction
        self._units[direction] += 1
        self.tallies[direction].histogram += tally.histogram
        self.ledgers[direction].extend(tally.ledgers.copy())
        self.part_rays[direction].extend(report.part_rays)
        if len(self.ledgers[direction]) >= 2 * MOST_LEDGERS:
            self.ledgers[direction] = _added_in_pairs(self.ledgers[direction])
            self.part_rays[direction] = _added_in_pairs(self.part_rays[direction])
        self.spending.book(direction, report.events, report.cpu_seconds)
        tally.clear()

    def state(self):
        """What has been added up, as a tree for `packing.pack`."""
        return {
            "histograms": [tally.histogram for tally in self.tallies],
            "units": self._units,
            "ledgers": [np.array(parts) for parts in self.ledgers],
            "part_rays": self.part_rays,
            "spending": self.spending.state(),
        }

    def restore(self, state):
        """Go on from such a tree; pieces of work are handed out anew."""
        for tally, histogram in zip(self.tallies, state["histograms"], strict=True):
            tally.histogram[...] = array(histogram, tally.histogram.shape)
        self._units = list(state["units"])
        shape = (-1, N_LEDGER, self._plan.n_distinct)
        self.ledgers = [list(array(parts, shape)) if len(parts) else [] for parts in state["ledgers"]]
        self.part_rays = [list(sizes) for sizes in state["part_rays"]]
        self.spending.restore(state["spending"])

    def finish_round(self, direction):
        """Nothing is left to do at a checkpoint."""

    def estimate(self, side, direction, order=None):
        """What is known of a component, or of one of its orders, in one direction.

        Parameters
        ----------
        side, direction : int
        order : int, optional
            Number of the slot among those of the way out; all by default.

        Returns
        -------
        goniosim.engine.estimate.Estimate
        """
        first, count, _ = (int(value) for value in self._plan.slots[side])
        first, count = (first, count) if order is None else (first + order, 1)
        rays = self.rays[direction]
        total, squares, hits = moments(self.tallies[direction].histogram, self._plan, first, count)
        energy, stderr = mean_and_error(total, squares, rays)
        _, total_stderr = sum_and_error(energy, stderr, Paths(energy, rays))
        return Estimate(energy, stderr, total_stderr, rays, hits)


def _added_in_pairs(values):
    return [a + b for a, b in zip(values[::2], values[1::2], strict=True)]
