"""Operators: a walk bins what arrives at a wide interface, whose BSDF is then applied to all cells at once.

Every arrival meets every cell, so that a few thousand light paths do the work of 10^9. The nodes leave a small bias,
which `Operator.coarse_minus_fine` bounds.
"""

from dataclasses import replace

import numpy as np

from ..operators import cells
from ..operators.application import Application, order_ahead
from ..operators.arrivals import bin_arrivals, waiting_rays
from ..operators.choice import IN, choose, inner_index
from ..operators.gather import POINTS, TAILS, gather

# Nodes half a degree apart.
NODES = 180
# Light paths between two looks at `stop`: some tens of milliseconds.
PATHS_PER_CALL = 1 << 13
# An event here, and a point of a cell, take as long as so many events of the analog walk; one of those as long as
# so many multiplications of a product of matrices.
EVENT, POINT, MULTIPLICATIONS = 9, 9, 300
_NUMBER = 8


class Operator:
    """Estimates of the slices of one way out.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    sides : tuple of int
        One way out, see `refusal`.
    nodes : int
        From the pole to grazing angles.
    """

    name = "operator"
    chunk = 8
    mends = False
    has_nodes = True

    @staticmethod
    def refusal(plan, sides):
        """One sentence why operators do not serve these ways out, or None."""
        if len(sides) != 1:
            return "an operator serves one way out"
        found = choose(plan, sides[0])
        return found if isinstance(found, str) else None

    @classmethod
    def tiny(cls, plan, sides):
        """One that runs the same kernels."""
        columns = 8 if cells.fits(plan, NODES) else 3
        few = replace(plan, theta_deg=plan.theta_deg[:1], light=plan.light[:1], rows=2, columns=columns)
        return cls(few, sides, nodes=4)

    def __init__(self, plan, sides, nodes=NODES):
        (side,) = sides
        self.plan = plan
        self.nodes = nodes
        self.variant = choose(plan, side)
        self.slots = int(plan.slots[side, 1])
        self.ahead = order_ahead(plan, self.variant, side)
        self.application = Application(plan, self.variant, self.nodes, self.slots, self.chunk)

    def prepare(self):
        """Tabulate the interface, for all incident directions."""
        self.application.prepare()

    @property
    def memory(self):
        """Bytes shared by all threads, and bytes of one workspace."""
        shared, own = self.application.memory
        channels = self.slots * self.plan.n_distinct
        # The bins of one replicate, and its values for the cells.
        return shared, own + 2 * _NUMBER * (2 * self.nodes + 1) * (self.nodes + 1) * channels

    def workspace(self):
        """Arrays of one thread."""
        return Workspace(self)

    def coarse_minus_fine(self, direction, size, keys):
        """Estimates by every second node and by every node, from the same light paths and points of cells.

        The difference bounds the bias of the fine ones: that is a fifteenth of it where lobes are smooth, and up to a
        half where corners of Fresnel's curve decide.

        Returns
        -------
        coarse, fine : ndarray
            As `Workspace.run` fills them.
        """
        shape = (2, len(keys), self.slots, self.plan.n_distinct, self.plan.rows, self.plan.width)
        found = np.empty(shape)
        workspace = self.workspace()
        for first in range(0, len(keys), self.chunk):
            some = slice(first, first + self.chunk)
            for i, stride in enumerate((2, 1)):
                workspace.run(direction, size, keys[some], found[i, some], None, stride)
        return found[0], found[1]


class Workspace:
    """Arrays of one thread, used for one chunk of replicates after the other."""

    def __init__(self, operator):
        plan, variant = operator.plan, operator.variant
        self.operator = operator
        self.space = operator.application.workspace()
        self.bins = np.empty((operator.slots, 2 * operator.nodes + 1, operator.nodes + 1, plan.n_distinct))
        self.waiting = waiting_rays(plan)
        self.stack = (plan.kinds, plan.alphas, plan.etas, plan.spectral, plan.taus, plan.absorbs)
        self.exits = self.source = np.empty(0)
        if variant.leaves == IN:
            self.exits = np.array([plan.alphas[variant.exit], inner_index(plan, variant.exit)])
        if variant.sees_light:
            self.source = np.array([plan.alphas[variant.interface], inner_index(plan, variant.interface)])

    def run(self, direction, size, keys, out, stop, stride=1):
        """Make a replicate for each key.

        Parameters
        ----------
        direction : int
            Number of the incident direction.
        size : int
            Light paths per replicate.
        keys : sequence of uint64
            At most `Operator.chunk`. The bits of a replicate are the same if the call has the same keys.
        out : ndarray, shape (len(keys), slots, distinct channels, rows, width)
            Overwritten: the fraction of the incident flux that leaves into each cell.
        stop : threading.Event or None
            When set, the replicates are given up.
        stride : int
            1, or 2 to use every second node.

        Returns
        -------
        int or None
            Ray-interface events, or what costs as much; None if it was given up.
        """
        operator = self.operator
        arrivals = operator.application.arrivals(self.space)
        arrivals[...] = 0.0
        events = 0
        for r, key in enumerate(keys):
            found = self._walk(direction, size, key, stop, stride)
            if found is None:
                return None
            events += EVENT * found
            self._take(r, arrivals, size)
        values = operator.application.apply(self.space)
        events += operator.application.multiplications // MULTIPLICATIONS
        for r, key in enumerate(keys):
            if stop is not None and stop.is_set():
                return None
            events += self._cells(direction, key, values[:, :, :, r], out[r], stride)
        return events

    def _walk(self, direction, size, key, stop, stride):
        variant = self.operator.variant
        target = np.array([variant.interface, variant.from_below, self.operator.ahead, stride])
        light = self.operator.plan.light[direction]
        self.bins[...] = 0.0
        events = 0
        for first in range(0, size, PATHS_PER_CALL):
            if stop is not None and stop.is_set():
                return None
            last = min(size, first + PATHS_PER_CALL)
            events += bin_arrivals(self.stack, light, target, first, last, key, self.waiting, self.bins)
        return events

    def _take(self, r, arrivals, size):
        """Put the bins of a replicate where the products of matrices expect them."""
        groups, channels = arrivals.shape[0], arrivals.shape[-1]
        self.bins *= 1.0 / size
        for g in range(groups):
            some = self.bins[..., g * channels : (g + 1) * channels]
            arrivals[g, :, :, r] = np.moveaxis(some, 0, 2)

    def _cells(self, direction, key, values, out, stride):
        """Fill the slices of a replicate from ``values[group, azimuth, polar, slot, channel]``; returns events."""
        plan = self.operator.plan
        if self.operator.application.sums_cells:
            slots, channels, rows, width = out.shape
            out.reshape(slots, len(values), -1, rows, width)[...] = values.transpose(3, 0, 4, 2, 1)
            return 0
        radiance = np.ascontiguousarray(values.transpose(1, 2, 3, 0, 4))
        radiance = radiance.reshape(*radiance.shape[:2], -1)
        gather(
            radiance,
            stride,
            plan.parametrization,
            plan.rows,
            plan.columns,
            plan.light[direction],
            self.exits,
            self.source,
            plan.taus[0],
            key,
            out.reshape(radiance.shape[2], -1),
        )
        return POINT * (POINTS + (TAILS if len(self.exits) else 0)) * plan.rows * plan.width
