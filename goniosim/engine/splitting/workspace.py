"""Queues, histograms and scratch arrays of one thread that makes replicates by the split walk."""

import math

import numpy as np

from ...slices import PARAMETRIZATIONS
from ..lattice import DIMENSIONS
from ..layout import N_LEDGER, WEIGHT
from ..sorting import LANES
from ..unit import BATCH, BUDGET, child_key, queue_capacity
from ..walk import MAX_ROUNDS
from .effort import CROWD
from .layout import EVENTS, LEFT, N_SCRATCH, N_STATE, PHASES
from .numbers import lattice_shifts
from .walk import split_walk

# Children of the key of a replicate.
_SHIFTS, _PATHS = 0, 1


def shapes(plan, slots):
    """Shapes of the arrays of float64, by name; ``slots`` is the number of histograms."""
    queues = 2 * len(plan.kinds) * PHASES
    fields = WEIGHT + plan.n_distinct + (1 if plan.orders else 0) + 2
    rings = slots * plan.rows if PARAMETRIZATIONS[plan.parametrization_name][1].RINGS else 1
    return {
        "queues": (queues, fields, queue_capacity(queues) + CROWD * BATCH),
        "batch": (fields, BATCH),
        # Not 512 numbers from row to row: in the nearest cache they would all claim the same few places.
        "scratch": (N_SCRATCH, BATCH + LANES),
        "histogram": (slots * plan.rows * plan.columns, plan.n_distinct),
        "rings": (rings, plan.n_distinct),
    }


class Workspace:
    """See `goniosim.engine.estimators`.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    slots : ndarray of int64, shape (2, 3)
        For each way out: first histogram, number of histograms (0 if nobody looks), first order.
    facets : ndarray of int64, shape (M, 2)
        Facets through which an arrival leaves.
    scales : ndarray, shape (M, queues, D)
        Reciprocals of the weights below which a ray is faint.
    effort : goniosim.engine.splitting.effort.Effort
    """

    def __init__(self, plan, slots, facets, scales, effort):
        self.plan = plan
        self.slots = slots
        self.facets = facets
        self.scales = scales
        self.effort = effort
        arrays = {name: np.zeros(shape) for name, shape in shapes(plan, int(slots[:, 1].sum())).items()}
        self.queues, self.batch, self.scratch = arrays["queues"], arrays["batch"], arrays["scratch"]
        self.histogram, self.rings = arrays["histogram"], arrays["rings"]
        self.state = np.zeros(N_STATE, np.int64)
        self.filled = np.zeros(len(self.queues), np.int64)
        sources = np.empty(BATCH, np.uint32)
        self.cells_of_deposits = np.empty(BATCH, np.int32)
        self.ledger = np.zeros((N_LEDGER, plan.n_distinct))
        self.shifts = np.empty(DIMENSIONS)
        self.space = (self.state, self.filled, self.queues, self.batch, self.scratch, sources)

    def run(self, direction, size, keys, out, stop):
        """Make replicates; returns what they cost in events, or None if ``stop`` was set."""
        events = 0
        for key, slices in zip(keys, out, strict=True):
            # At least one: of none at all, neither energies nor their errors would be known.
            paths = math.ceil(size * self.effort.followed[direction])
            self.begin(paths)
            lattice_shifts(child_key(key, _SHIFTS), self.shifts)
            crowd = self.effort.crowds[direction]
            while not self.advance(direction, child_key(key, _PATHS), BUDGET, crowd):
                if stop.is_set():
                    return None
            events += int(self.state[EVENTS])
            self._collect(paths, slices)
        return events

    def begin(self, size):
        """Forget everything; ``size`` paths wait to be started."""
        self.histogram.fill(0.0)
        self.rings.fill(0.0)
        self.filled[:] = 0
        self.state[:] = 0
        self.state[LEFT] = size
        self.shifts[:] = 0.0

    def advance(self, direction, key, budget, crowd):
        """Run about ``budget`` events, and at least one stage; returns whether all paths are through.

        Where the fullest queue holds more than ``crowd`` rays, inner interfaces do not branch.
        """
        plan = self.plan
        light = plan.light[direction]
        parametrization = PARAMETRIZATIONS[plan.parametrization_name][1]
        cells = (
            plan.parametrization,
            plan.rows,
            plan.columns,
            light,
            self.slots,
            self.cells_of_deposits,
            self.histogram,
            self.rings,
            parametrization.RINGS,
            plan.width < plan.columns,
        )
        scales, facets = self.scales[direction], self.facets[direction]
        # What is still inside after that is lost, as in the analog walk.
        rounds = int(MAX_ROUNDS * len(self.filled) * self.effort.patience[direction])
        return split_walk(
            plan.tables, scales, facets, crowd, light, key, self.shifts, budget, rounds, self.space, self.ledger, cells
        )

    def _collect(self, paths, slices):
        """Energy per cell of the whole slice, on the columns that tell all; each of the paths stands for as much."""
        plan = self.plan
        cells = self.histogram.reshape(len(slices), plan.rows, plan.columns, plan.n_distinct)
        share = 1.0 / paths
        if plan.width < plan.columns:
            # The azimuth of 180 degrees belongs to the column behind it, which the fold puts on the one before it.
            cells[:, :, plan.width - 1] += cells[:, :, plan.width]
            share *= 0.5
        np.multiply(np.moveaxis(cells[:, :, : plan.width], -1, 1), share, out=slices)
        if PARAMETRIZATIONS[plan.parametrization_name][1].RINGS:
            rings = self.rings.reshape(len(slices), plan.rows, plan.n_distinct)
            slices += np.moveaxis(rings, -1, 1)[..., None] / (paths * plan.columns)
