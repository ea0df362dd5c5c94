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
from .unit import PARTS, Tally, Workspace, unit_key

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
        self._open = [None] * directions
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
        checkpoints, ends = set(schedule.checkpoints), set(schedule.ends)
        made = []
        for direction, unit, share in map(schedule.__getitem__, range(len(schedule))):
            m = chosen[direction]
            made.append(Work(m, self._issued[m], share, last=unit + 1 in checkpoints, ends=unit + 1 in ends))
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
        self._add(direction, tally.histogram, work.ends)
        self._book(direction, tally.ledgers.copy(), report.part_rays)
        self.spending.book(direction, report.events, report.cpu_seconds)
        tally.clear()

    def _add(self, direction, histogram, ends):
        held = self._open[direction]
        if held is not None:
            held += histogram
        elif not ends:
            self._open[direction] = histogram.copy()
        if ends:
            self.tallies[direction].histogram += histogram if held is None else held
            self._open[direction] = None

    def _book(self, direction, ledgers, part_rays):
        self._units[direction] += 1
        self.ledgers[direction].extend(ledgers)
        self.part_rays[direction].extend(part_rays)
        if len(self.ledgers[direction]) >= 2 * MOST_LEDGERS:
            self.ledgers[direction] = _added_in_pairs(self.ledgers[direction])
            self.part_rays[direction] = _added_in_pairs(self.part_rays[direction])

    def state(self, direction):
        """What has been added up of one direction, as a tree for `packing.pack`."""
        return {
            "histogram": self.tallies[direction].histogram,
            "open": self._open[direction],
            "units": self._units[direction],
            "ledgers": np.array(self.ledgers[direction]),
            "part_rays": self.part_rays[direction],
            "spending": self.spending.state(direction),
        }

    def restore(self, direction, state):
        """Go on from such a tree; pieces of work are handed out anew."""
        tally = self.tallies[direction].histogram
        tally[...] = array(state["histogram"], tally.shape)
        self._open[direction] = None if state["open"] is None else array(state["open"], tally.shape)
        self._units[direction] = int(state["units"])
        parts = state["ledgers"]
        self.ledgers[direction] = list(array(parts, self._shape_of_ledgers)) if len(parts) else []
        self.part_rays[direction] = _sizes(state["part_rays"], len(self.ledgers[direction]))
        self.spending.restore(direction, state["spending"])

    @property
    def _shape_of_ledgers(self):
        return -1, N_LEDGER, self._plan.n_distinct

    def apart(self):
        """Sums of a section of their own."""
        return SectionOfUnits(self._plan)

    def reduce_apart(self, section, work, report, tally):
        """Add up a work unit in a section of its own."""
        section.add(tally, report.part_rays)

    def join(self, works, state):
        """Take in a section, of some pieces of work, that was added up elsewhere."""
        direction, section = works[0].direction, self.apart()
        section.restore(state)
        self.require_apart(section, works)
        self.finish_round(direction)
        self._add(direction, section.histogram, True)
        for first in range(0, len(section.ledgers), PARTS):
            self._book(direction, section.ledgers[first : first + PARTS], section.part_rays[first : first + PARTS])

    def require_apart(self, section, works):
        """Raise a ValueError if what was added up in a section of its own is not just these pieces of work."""
        sizes = section.part_rays
        if len(sizes) != PARTS * len(works) or sum(sizes) != sum(work.rays for work in works):
            raise _contradiction()

    def require(self, direction, works):
        """Raise a ValueError if what was added up of a direction is not just these pieces of work."""
        if self._units[direction] != len(works) or self.rays[direction] != sum(work.rays for work in works):
            raise _contradiction()

    def finish_round(self, direction):
        """Close the section that is open."""
        if self._open[direction] is not None:
            self.tallies[direction].histogram += self._open[direction]
            self._open[direction] = None

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
        return Estimate(energy, stderr, total_stderr, rays, hits, paths=rays)


class SectionOfUnits:
    """What some work units of one direction add up to, in the order of their numbers.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan

    Attributes
    ----------
    histogram : ndarray
        As of a tally.
    ledgers, part_rays : list
        Of the parts of the work units.
    """

    def __init__(self, plan):
        self.histogram, self.ledgers, self.part_rays = Tally(plan).histogram, [], []
        self._shape_of_ledgers = -1, N_LEDGER, plan.n_distinct

    def add(self, tally, part_rays):
        """Take in a work unit, and clear its tally."""
        self.histogram += tally.histogram
        self.ledgers.extend(tally.ledgers.copy())
        self.part_rays.extend(part_rays)
        tally.clear()

    def state(self):
        """As a tree for `packing.pack`."""
        return {"histogram": self.histogram, "ledgers": np.array(self.ledgers), "part_rays": self.part_rays}

    def restore(self, state):
        """Go on from such a tree."""
        self.histogram[...] = array(state["histogram"], self.histogram.shape)
        ledgers = state["ledgers"]
        self.ledgers = list(array(ledgers, self._shape_of_ledgers)) if len(ledgers) else []
        self.part_rays = _sizes(state["part_rays"], len(self.ledgers))


def _sizes(values, count):
    """Rays of so many parts."""
    found = [int(size) for size in values]
    if len(found) != count or min(found, default=0) < 0:
        raise _contradiction()
    return found


def _contradiction():
    return ValueError("not the state of this run: numbers of parts or rays that contradict each other")


def _added_in_pairs(values):
    return [a + b for a, b in zip(values[::2], values[1::2], strict=True)]
