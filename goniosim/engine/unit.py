"""One work unit: a share of the rays of one direction, traced on one thread into a tally of its own."""

import time
from dataclasses import dataclass

import numpy as np

from .._jit import kernel
from ..optics.random import derive_key
from .layout import EVENTS, LEFT, N_LEDGER, N_SCRATCH, N_STATE, WEIGHT
from .tally import record_length
from .walk import walk

BATCH = 512
# Events per call of the kernel, which cannot be interrupted: some tens of milliseconds.
BUDGET = 1 << 22


class Tally:
    """Histograms and ledger of one work unit, or their sums over several.

    Attributes
    ----------
    histogram : ndarray, shape (slots * rows * columns, record)
        See `tally.add_deposits`.
    ledger : ndarray, shape (N_LEDGER, channels)
        Energies by where they went, in units of one ray's flux.
    """

    def __init__(self, plan):
        cells = plan.n_slots * plan.rows * plan.columns
        self.histogram = np.zeros((cells, record_length(plan.n_distinct)))
        self.ledger = np.zeros((N_LEDGER, plan.n_distinct))

    def clear(self):
        """Forget everything."""
        self.histogram.fill(0.0)
        self.ledger.fill(0.0)


@dataclass
class UnitReport:
    """What a work unit cost."""

    rays: int
    events: int
    cpu_seconds: float


class Workspace:
    """Queues and scratch arrays of one thread, used for one work unit after the other."""

    def __init__(self, plan):
        k = len(plan.kinds)
        fields = WEIGHT + plan.n_distinct + (1 if plan.orders else 0)
        self.plan = plan
        self.state = np.zeros(N_STATE, np.int64)
        self.filled = np.zeros(2 * k, np.int64)
        # Rays are launched only while every queue holds less than a batch, so this never overflows.
        queues = np.empty((2 * k, fields, (2 * k + 1) * BATCH))
        work = np.empty((fields, BATCH))
        scratch = np.empty((N_SCRATCH, BATCH))
        steps = np.empty(BATCH, np.uint64)
        places = np.empty((2, BATCH), np.uint32)
        exits = np.empty((2, fields, 2 * BATCH))
        self.n_exits = np.zeros(2, np.int64)
        self.space = (self.state, self.filled, queues, work, scratch, steps, places, exits, self.n_exits)
        # In the analog estimator a path leaves once: every deposit is a path of its own.
        self.paths = np.arange(2 * BATCH, dtype=np.int64)
        self.cells = np.empty(2 * BATCH, np.int32)

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
        self.state[:] = 0
        self.state[LEFT] = rays
        self.filled[:] = 0
        self.n_exits[:] = 0
        light = plan.light[direction]
        cells = (
            plan.parametrization,
            plan.rows,
            plan.columns,
            light,
            plan.slots,
            self.paths,
            self.cells,
            tally.histogram,
            plan.n_distinct,
        )
        start = time.thread_time()
        while not walk(
            plan.tables,
            light,
            key,
            BUDGET,
            self.space,
            tally.ledger,
            cells,
        ):
            if stop.is_set():
                return None
        return UnitReport(rays, int(self.state[EVENTS]), time.thread_time() - start)


def unit_key(seed, direction, unit):
    """Key (uint64) of the random numbers of one work unit."""
    return np.uint64(_unit_key(seed, direction, unit))


@kernel
def _unit_key(seed, direction, unit):
    return derive_key(derive_key(derive_key(seed, 0), direction), unit)
