"""One work unit: a share of the rays of one direction, traced on one thread into a tally of its own."""

import math
import time
from dataclasses import dataclass

import numpy as np

from .._jit import kernel
from ..optics.random import derive_key
from .layout import EVENTS, LEFT, N_LEDGER, N_SCRATCH, N_STATE, WEIGHT
from .sorting import LANES
from .tally import aligned, empty_records
from .walk import walk

BATCH = 512
# Independent parts of a work unit, each with an energy balance of its own: 16 units have 64, whose
# scatter is a standard error to 9 %. More units instead would have to clear and add up more histograms.
PARTS = 4
# Weights below are no numbers to divide by.
DARKEST = 1e-297
# Children of the seed's key.
UNITS, PILOT = 0, 1
# Events per call of the kernel, which cannot be interrupted: some tens of milliseconds.
BUDGET = 1 << 22


class Tally:
    """Histograms and ledgers of one work unit, or sums of histograms over several.

    Attributes
    ----------
    histogram : ndarray, shape (slots * rows * columns, record)
        See `tally.add_deposits`.
    ledgers : ndarray, shape (PARTS, N_LEDGER, channels)
        Of each part: energies by where they went, in units of one ray's flux.
    """

    def __init__(self, plan):
        cells = plan.n_slots * plan.rows * plan.columns
        self.histogram = empty_records(cells, plan.n_distinct)
        self.ledgers = np.zeros((PARTS, N_LEDGER, plan.n_distinct))

    def clear(self):
        """Forget everything."""
        self.histogram.fill(0.0)
        self.ledgers.fill(0.0)


@dataclass
class UnitReport:
    """What a work unit cost, and the rays of its parts."""

    part_rays: list
    events: int
    cpu_seconds: float

    @property
    def rays(self):
        """Rays traced."""
        return sum(self.part_rays)


def queue_capacity(queues):
    """Rays that each of so many queues must have room for.

    In units of a batch, no j of n queues hold more than j (1 + 1/j + 1/(j + 1) + ... + 1/n) together, so none
    holds more than 1 + (1 + 1/2 + ... + 1/n). It is so after a launch, which adds one batch while
    every queue holds less than one. Serving takes a batch from the fullest queue, and adds no more in
    all. If the fullest is one of the j, these gain nothing. If not, they held at most the share
    j / (j + 1) of what they and the fullest did, and gain one at most: that is the bound again.
    Behind the last ray of a queue is room for the lanes that are moved along with it.
    """
    most = BATCH * (1.0 + math.fsum(1.0 / j for j in range(1, queues + 1)))
    return LANES * (math.ceil(most / LANES) + 1)


class Workspace:
    """Queues and scratch arrays of one thread, used for one work unit after the other.

    Parameters
    ----------
    plan : Plan
    faint : ndarray, shape (M, 2 K, distinct channels), optional
        Weights below which a ray plays Russian roulette, see `faint.faint_weights`; by default only
        rays without any weight are ended.
    """

    def __init__(self, plan, faint=None):
        k = len(plan.kinds)
        faint = np.full((len(plan.theta_deg), 2 * k, plan.n_distinct), DARKEST) if faint is None else faint
        self.scales = 1.0 / faint
        fields = WEIGHT + plan.n_distinct + (1 if plan.orders else 0)
        self.plan = plan
        self.state = np.zeros(N_STATE, np.int64)
        self.filled = np.zeros(2 * k, np.int64)
        self.queues = aligned((2 * k, fields, queue_capacity(2 * k)))
        # Not 512 numbers from row to row: in the nearest cache they would all claim the same few places.
        scratch = aligned((N_SCRATCH, BATCH + LANES))
        steps = np.empty(BATCH, np.uint64)
        places = np.empty((2, BATCH), np.uint32)
        exits = aligned((2, fields, 2 * BATCH + LANES))
        self.n_exits = np.zeros(2, np.int64)
        self.space = (self.state, self.filled, self.queues, scratch, steps, places, exits, self.n_exits)
        self.places = np.empty(2 * BATCH, np.int32)

    def run(self, direction, rays, key, tally, stop):
        """Trace ``rays`` rays from a direction into ``tally``, which must be clear.

        Parameters
        ----------
        direction : int
        rays : int
        key : uint64
            Key of the unit's random numbers.
        tally : Tally
        stop : threading.Event
            When set, the unit is given up.

        Returns
        -------
        UnitReport or None
            None if the unit was given up.
        """
        plan = self.plan
        cells = self.cells(direction, plan.rows, plan.columns, tally.histogram)
        part_rays = [rays * (part + 1) // PARTS - rays * part // PARTS for part in range(PARTS)]
        events = 0
        start = time.thread_time()
        for part, share in enumerate(part_rays):
            part_key = child_key(key, part)
            self.begin(share)
            while not self.advance(direction, part_key, BUDGET, tally.ledgers[part], cells):
                if stop.is_set():
                    return None
            events += int(self.state[EVENTS])
        return UnitReport(part_rays, events, time.thread_time() - start)

    def begin(self, rays):
        """Forget what was traced before; ``rays`` rays wait to be launched."""
        self.state[:] = 0
        self.state[LEFT] = rays
        self.filled[:] = 0
        self.n_exits[:] = 0

    def cells(self, direction, rows, columns, histogram):
        """What `tally.flush` needs to deposit into slices of so many cells."""
        plan = self.plan
        light = plan.light[direction]
        return (
            plan.parametrization,
            rows,
            columns,
            light,
            plan.slots,
            self.places,
            histogram,
            plan.n_distinct,
        )

    def advance(self, direction, key, budget, ledger, cells):
        """Run about ``budget`` events, and at least one stage; returns whether all rays are through."""
        plan = self.plan
        return walk(plan.tables, self.scales[direction], plan.light[direction], key, budget, self.space, ledger, cells)


def unit_key(seed, direction, unit):
    """Key (uint64) of the random numbers of one work unit."""
    return child_key(child_key(child_key(seed, UNITS), direction), unit)


def pilot_key(direction):
    """Key (uint64) of random numbers that no work unit uses."""
    return child_key(child_key(0, PILOT), direction)


def child_key(key, number):
    """Key (uint64) of the ``number``-th child of a key or seed."""
    return np.uint64(_child_key(np.uint64(key), number))


@kernel
def _child_key(key, number):
    return derive_key(key, number)
