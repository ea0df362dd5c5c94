"""Operators: a walk bins what arrives at a wide interface, whose BSDF is then applied to all cells at once.

Every arrival meets every cell, so that a few thousand light paths do the work of 10^9. The nodes leave a small bias,
which `Operator.coarse_minus_fine` bounds.
"""

import math
from dataclasses import replace

import numpy as np

from ..operators import cells, rays
from ..operators.application import Application, order_ahead
from ..operators.arrivals import bin_arrivals
from ..operators.choice import IN, choose, finer, inner_index
from ..operators.exits import TAILS
from ..operators.gather import POINTS, POINTS_OF_EXIT, gather
from ..operators.light import LIGHTS
from ..operators.stencils import padded
from ..rounds import SMALLEST
from ..unit import BATCH

# Nodes half a degree apart.
NODES = 180
# Events of the walk between two looks at `stop`: some tens of milliseconds.
BUDGET = 1 << 20
# An event here, and a look at the radiance, take as long as so many events of the analog walk; one of those as long as
# so many multiplications of a product of matrices.
EVENT, LOOK, MULTIPLICATIONS = 2, 2, 300
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
    polar : int, optional
        The same for the polar angles of arrivals only; by default by the width of the exit.
    """

    name = "operator"
    chunk = 8
    # Paths cost little beside what is done with them, and fewer may miss what dim blocks rest on.
    smallest = 2 * SMALLEST
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

    def __init__(self, plan, sides, nodes=NODES, polar=None):
        (side,) = sides
        self.plan = plan
        self.nodes = nodes
        self.variant = choose(plan, side)
        self.slots = int(plan.slots[side, 1])
        self.ahead = order_ahead(plan, self.variant, side)
        polar = polar or nodes * finer(plan, self.variant)
        self.application = Application(plan, self.variant, self.nodes, polar, self.slots, self.chunk)

    def prepare(self):
        """Tabulate the interface, for all incident directions."""
        self.application.prepare()

    @property
    def looks(self):
        """Looks at the radiance that all cells of a slice take once."""
        each = POINTS
        if self.variant.leaves == IN:
            each = POINTS_OF_EXIT + TAILS + (LIGHTS if self.variant.sees_light else 0)
        return each * self.plan.rows * self.plan.width

    def parts(self, size):
        """Into how many parts cells are cut along the column and along the row, in replicates of so many light paths.

        Each part has points of its own, whose scatter is a floor that no number of light paths would lower. So there
        are as many looks as light paths, once those are more than the cells take: they cost a third of these.
        """
        parts = max(1, size // self.looks)
        high = math.isqrt(parts)
        return high, parts // high

    @property
    def memory(self):
        """Bytes shared by all threads, and bytes of one workspace."""
        shared, own = self.application.memory
        walk = sum(math.prod(shape) for shape in rays.shapes(self.plan).values())
        # Besides the walk, the radiance of one replicate at the nodes, where cells are not summed.
        at_node = 0 if self.application.sums_cells else padded(self.slots * self.plan.n_distinct)
        return shared, own + _NUMBER * (walk + (2 * self.nodes + 1) * (self.nodes + 1) * at_node)

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
        self.walk = rays.workspace(plan)
        shape = (2 * operator.nodes + 1, operator.nodes + 1, padded(operator.slots * plan.n_distinct))
        self.radiance = np.zeros(0 if operator.application.sums_cells else math.prod(shape))
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
        found = self._walk(direction, size, keys, stop, stride)
        if found is None:
            return None
        events = EVENT * found
        values = operator.application.apply(self.space)
        events += operator.application.multiplications // MULTIPLICATIONS
        for r, key in enumerate(keys):
            found = self._cells(direction, size, key, values[:, :, :, r], out[r], stop, stride)
            if found is None:
                return None
            events += found
        return events

    def _walk(self, direction, size, keys, stop, stride):
        """Bin the arrivals of all replicates where `Application.apply` expects them; returns events of the walk."""
        operator = self.operator
        variant = operator.variant
        target = np.array([variant.interface, variant.from_below, operator.ahead])
        light = operator.plan.light[direction]
        bins = operator.application.bins(self.space, stride)
        some = bins[: len(keys) * operator.slots]
        bins[len(some) :] = 0.0
        state, filled = self.walk[:2]
        state[:] = 0
        filled[:] = 0
        paths = np.array(keys, np.uint64)
        crowd = rays.CROWD * BATCH
        while not bin_arrivals(self.stack, light, target, size, paths, crowd, BUDGET, self.walk, some):
            if stop is not None and stop.is_set():
                return None
        operator.application.take(self.space, stride, 1.0 / size)
        return int(state[rays.EVENTS])

    def _cells(self, direction, size, key, values, out, stop, stride):
        """Fill the slices of a replicate from ``values[group, azimuth, polar, slot, channel]``; returns events."""
        operator, plan = self.operator, self.operator.plan
        if operator.application.sums_cells:
            slots, channels, rows, width = out.shape
            out.reshape(slots, len(values), -1, rows, width)[...] = values.transpose(3, 0, 4, 2, 1)
            return 0
        radiance, high, wide = self._radiance(values[:, ::stride, ::stride]), *operator.parts(size)
        out[...] = 0.0
        for strip in range(high):
            if stop is not None and stop.is_set():
                return None
            gather(
                radiance,
                plan.parametrization,
                plan.rows,
                plan.columns,
                (high, wide),
                strip,
                plan.light[direction],
                self.exits,
                self.source,
                plan.taus[0],
                key,
                out.reshape(-1, plan.rows * plan.width),
            )
        return LOOK * operator.looks * high * wide

    def _radiance(self, values):
        """Numbers of a replicate, side by side for each of the nodes that are used."""
        groups, azimuths, polar, slots, channels = values.shape
        count = groups * slots * channels
        shape = (azimuths, polar, padded(count))
        radiance = self.radiance[: math.prod(shape)].reshape(shape)
        radiance[:, :, :count].reshape(azimuths, polar, slots, groups, channels)[...] = values.transpose(1, 2, 3, 0, 4)
        return radiance
