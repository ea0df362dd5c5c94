"""A run of replicates: rounds of equally many, each twice as large as before."""

import time
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..slices import PARAMETRIZATIONS
from .estimate import Estimate, noise
from .packing import array
from .replicates import Replicates, contradiction, unfold
from .rounds import REPLICATES as N_REPLICATES
from .rounds import chunks, sizes
from .runs import Spending, Work
from .section import SECTION, Section
from .unit import child_key

# Child of the seed's key, beside the work units' and the pilot's.
BRANCH = 2


@dataclass(frozen=True)
class _Report:
    events: int
    cpu_seconds: float


class ReplicatedRun:
    """Slices of some ways out by one estimator.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    estimator : object
        See `goniosim.engine.estimators`.
    sides : tuple of int
        Ways out that it serves.
    key : int or uint64
        Seed of the random numbers.

    Attributes
    ----------
    spending : goniosim.engine.runs.Spending
    bias : dict of int to float
        By direction, what nodes may be off by, in sr^-1/2; empty for estimators without.
    """

    audits = False
    # Pieces that wait for their turn, for each thread: those of a hard direction take several times as long.
    waiting = 3

    def __init__(self, plan, estimator, sides, key):
        self.sides = sides
        self.name = estimator.name
        self._plan, self._estimator = plan, estimator
        self._key = child_key(key, BRANCH)
        self._shape = (plan.n_distinct, plan.rows, plan.width)
        self._views, self._place = _views(plan, self.sides)
        directions = len(plan.theta_deg)
        alike = PARAMETRIZATIONS[plan.parametrization_name][1].ALIKE if estimator.mends else None
        self._section = partial(Section, self._views, self._shape, plan.columns)
        self._sums = [Replicates(self._views, self._shape, plan.columns, alike) for _ in range(directions)]
        self._issued = [0] * directions
        self._first = {}
        self.bias = {}
        self._rounds = 0
        self.spending = Spending(directions)

    @property
    def finished(self):
        """Whether all light paths are through that were handed out."""
        return self.rays == self._issued

    @property
    def rays(self):
        """Light paths in finished rounds, of each direction."""
        return [sums.paths for sums in self._sums]

    def prepare(self):
        """Make what all directions share."""
        start = time.thread_time()
        self._estimator.prepare()
        self.spending.share(time.thread_time() - start)

    @property
    def gathered(self):
        """Whether there is something to keep of every direction."""
        return all(sums.gathered for sums in self._sums)

    def rounds(self, rays):
        """Pieces of work of so many light paths of each direction, or a few more, by rounds: lists of Work."""
        return [self._round(size, range(len(self._sums))) for size in sizes(rays, self._estimator.smallest)]

    def rays_of_round(self, number):
        """Light paths of a direction in a round of a run that stops at an accuracy."""
        return N_REPLICATES * self._estimator.smallest << number

    def round(self, number, directions):
        """Pieces of work of such a round."""
        return self._round(self._estimator.smallest << number, directions)

    def _round(self, size, directions):
        pieces = chunks(self._estimator.chunk)
        number = self._rounds
        self._rounds += 1
        for m in directions:
            self._issued[m] += size * N_REPLICATES
        # All directions advance together.
        made = [
            Work(m, number, size * len(piece), piece, last=piece is pieces[-1], ends=piece.stop % SECTION == 0)
            for piece in pieces
            for m in directions
        ]
        if number == 0 and self._estimator.has_nodes:
            first = len(directions)
            # Where there is one piece only, the checkpoint is not before it.
            made[first:first] = [Work(m, number, size * len(pieces[0]), pieces[0], coarse=True) for m in directions]
        return made

    def buffer(self):
        """What a piece of work fills."""
        return np.empty((self._estimator.chunk, self._slots, *self._shape))

    @property
    def _slots(self):
        return int(sum(self._plan.slots[side, 1] for side in self.sides))

    def workspace(self):
        """Scratch arrays of one thread."""
        return self._estimator.workspace()

    def work(self, work, buffer, workspace, stop):
        """Make replicates; returns a report, None if they were given up."""
        start = time.thread_time()
        keys = [self._key_of(work, number) for number in work.replicates]
        out = buffer[: len(keys)]
        coarse = {"stride": 2} if work.coarse else {}
        events = workspace.run(work.direction, work.rays // len(keys), np.array(keys, np.uint64), out, stop, **coarse)
        return None if events is None else _Report(events, time.thread_time() - start)

    def _key_of(self, work, number):
        return child_key(child_key(child_key(self._key, work.direction), work.number), number)

    def reduce(self, work, report, buffer):
        """Add up replicates."""
        start = time.thread_time()
        size, found = work.rays // len(work.replicates), buffer[: len(work.replicates)]
        if work.coarse:
            self._see_bias(work.direction, found)
        else:
            if work.number == 0 and work.replicates.start == 0 and self._estimator.has_nodes:
                self._first[work.direction] = found.mean(axis=0)
            for number, slots in zip(work.replicates, found, strict=True):
                self._sums[work.direction].add(number, size, slots)
        self.spending.book(work.direction, report.events, report.cpu_seconds + time.thread_time() - start)

    def _see_bias(self, direction, coarse):
        """What twice the distance of the nodes changes: more than their bias, which falls with a power of it."""
        # The nodes serve one way out.
        change = (coarse.mean(axis=0) - self._first.pop(direction)).sum(axis=0)
        self.bias[direction] = noise(self._plan, direction, unfold(change, self._plan.columns))

    def state(self, direction):
        """What has been added up of one direction, as a tree for `packing.pack`."""
        return {
            "sums": self._sums[direction].state(),
            "first": self._first.get(direction),
            "bias": self.bias.get(direction),
            "spending": self.spending.state(direction),
        }

    def restore(self, direction, state):
        """Go on from such a tree; pieces of work are handed out anew."""
        self._sums[direction].restore(state["sums"])
        if state["first"] is not None:
            self._first[direction] = array(state["first"], (self._slots, *self._shape))
        if state["bias"] is not None:
            self.bias[direction] = float(state["bias"])
        self.spending.restore(direction, state["spending"])

    def apart(self):
        """Sums of a section of their own."""
        return self._section()

    def reduce_apart(self, section, work, report, buffer):
        """Add up replicates in a section of its own: not one of the first, which tells the bias of the nodes."""
        for slots in buffer[: len(work.replicates)]:
            section.add(slots)

    def join(self, works, state):
        """Take in a section, of some pieces of work, that was added up elsewhere."""
        section = self.apart()
        section.restore(state)
        self.require_apart(section, works)
        self._sums[works[0].direction].join(works[0].rays // len(works[0].replicates), section)

    def require_apart(self, section, works):
        """Raise a ValueError if what was added up in a section of its own is not just these pieces of work."""
        if section.count != sum(len(work.replicates) for work in works):
            raise contradiction()

    def require(self, direction, works):
        """Raise a ValueError if what was added up of a direction is not just these pieces of work."""
        whole = [work for work in works if not work.coarse]
        self._sums[direction].require(sum(len(work.replicates) for work in whole), sum(work.rays for work in whole))

    def finish_round(self, direction):
        """Add a round up, or what there is of it."""
        self._sums[direction].finish_round()

    def estimate(self, side, direction, order=None):
        """What is known of a component, or of one of its orders, in one direction: as `analog.AnalogRun.estimate`."""
        view, sums = self._place[side, order], self._sums[direction]
        energy, stderr = sums.slices(view)
        bias = self.bias.get(direction) if order is None else None
        batches, paths = sums.batches(view), sums.paths
        return Estimate(energy, stderr, sums.total_stderr(view), sums.count, batches=batches, bias=bias, paths=paths)


def _views(plan, sides):
    """Slots of the components and of their orders, and the place of each among them by way out and order."""
    views, place, first = [], {}, 0
    for side in sides:
        count = int(plan.slots[side, 1])
        place[side, None] = len(views)
        views.append(slice(first, first + count))
        for order in range(count):
            place[side, order] = len(views) if plan.orders else place[side, None]
            if plan.orders:
                views.append(slice(first + order, first + order + 1))
        first += count
    return views, place
