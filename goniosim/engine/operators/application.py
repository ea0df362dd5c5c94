"""The products of matrices between binned arrivals and what leaves: at the nodes, or in classic cells."""

import math

import numpy as np

from ...slices.grid import HALF_PI
from ..layout import UP
from ..stages import ROUGH_CONDUCTOR
from ..stages.smooth_conductor import ETA, KAPPA
from . import cells, kernels
from .azimuths import at_azimuths, cosines, to_coefficients, to_values
from .bins import move_bins
from .choice import IN, OUT, THROUGH, inner_index

_NUMBER = 8


class Application:
    """One interface, or two, applied to the arrivals of several replicates.

    Attributes
    ----------
    sums_cells : bool
        Whether `apply` yields energies of classic cells instead of radiance at the nodes.
    """

    def __init__(self, plan, variant, nodes, polar, slots, replicates):
        self.plan = plan
        self.variant = variant
        self.nodes = nodes
        self.polar = polar
        self.slots = slots
        self.replicates = replicates
        k = variant.interface
        self.conductor = variant.leaves != OUT and plan.kinds[k] == ROUGH_CONDUCTOR
        # Channels that reflect differently have kernels of their own.
        self.groups = plan.n_distinct if self.conductor else 1
        self.sums_cells = variant.leaves != IN and cells.fits(plan, nodes)
        every = cells.Nodes(nodes)
        last = cells.CellRows(plan, nodes) if self.sums_cells else every
        self.rows = [every, last] if variant.leaves == THROUGH else [last]
        self.azimuths = plan.width if self.sums_cells else 2 * nodes + 1
        self.kernels = None

    def prepare(self):
        """Tabulate the kernels, for all incident directions."""
        plan, variant = self.plan, self.variant
        k = variant.interface
        self.matrix = cosines(2 * self.nodes)
        first = self._table(self.groups, 0)
        if self.conductor:
            for c in range(self.groups):
                eta, kappa = plan.spectral[k, ETA, c], plan.spectral[k, KAPPA, c]
                self._tabulate(kernels.CONDUCTOR, k, eta, kappa, self.rows[0], first[c])
        else:
            event = kernels.TRANSMISSION if variant.leaves == OUT else kernels.INTERNAL
            self._tabulate(event, k, inner_index(plan, k), 0.0, self.rows[0], first[0])
        self.kernels = [first]
        if variant.leaves == THROUGH:
            second = self._table(1, 1)
            eta = inner_index(plan, variant.exit)
            self._tabulate(kernels.TRANSMISSION, variant.exit, eta, 0.0, self.rows[1], second[0])
            # The exit sees light come from where it does not go.
            second[:, 1::2] *= -1.0
            self.kernels.append(second)
            self.toll = self._toll()
        if self.sums_cells:
            self.to_azimuths = cells.column_matrix(plan, self.nodes, at_azimuths)
        else:
            self.to_azimuths = at_azimuths(2 * self.nodes, np.arange(2 * self.nodes + 1))

    def _table(self, groups, stage):
        return np.empty((groups, 2 * self.nodes + 1, len(self.rows[stage]), self._incoming[stage]))

    def _tabulate(self, event, k, eta, kappa, rows, found):
        kernels.coefficients(event, float(self.plan.alphas[k]), float(eta), float(kappa), rows, self.matrix, found)

    def _toll(self):
        """Quadrature weights of the nodes for a cosine-weighted integral, with what the way to the exit leaves.

        Shape (groups, 1, polar angles, channels of a group).
        """
        angle = np.linspace(0.0, HALF_PI, self.nodes + 1)
        step = angle[1]
        measure = np.sin(angle) * step
        # The pole has a share of the first interval.
        measure[0] = step * step / 12.0
        cosine = np.maximum(np.cos(angle), 1e-300)
        tau = self.plan.taus[0].reshape(self.groups, 1, 1, -1)
        with np.errstate(under="ignore"):
            passed = np.exp(-tau / cosine[:, None])
        return (measure * cosine * (math.pi / (2 * self.nodes)))[:, None] * passed

    @property
    def _incoming(self):
        """Polar angles of what each kernel is applied to: of the arrivals, and of what has left the first interface."""
        return [self.polar + 1, len(self.rows[0])][: len(self.rows)]

    @property
    def columns(self):
        """Columns of the matrices: replicates, slots and channels of a group."""
        return self.replicates * self.slots * self.plan.n_distinct // self.groups

    def workspace(self):
        """Two arrays that `apply` goes back and forth between; it begins with the arrivals in the first."""
        size = self.groups * (2 * self.nodes + 1) * self._most_polar * self.columns
        return np.empty(size), np.empty(size)

    @property
    def _most_polar(self):
        return max(self.polar + 1, *(len(rows) for rows in self.rows))

    def bins(self, space, stride):
        """Where a walk bins arrivals at every ``stride``-th node: in the second array, which `apply` overwrites later.

        Shape (replicates * slots, azimuths, polar angles * channels).
        """
        azimuths, polar = 2 * self.nodes // stride + 1, self.polar // stride + 1
        shape = (self.replicates * self.slots, azimuths, polar * self.plan.n_distinct)
        return space[1][: math.prod(shape)].reshape(shape)

    def take(self, space, stride, factor):
        """Move ``factor`` times the bins to where `apply` expects them."""
        bins = self.bins(space, stride)
        bins = bins.reshape(*bins.shape[:2], self.polar // stride + 1, self.groups, -1)
        arrivals = self._arrivals(space[0]).reshape(self.groups, 2 * self.nodes + 1, self.polar + 1, bins.shape[0], -1)
        if stride > 1:
            arrivals[...] = 0.0
        move_bins(bins, factor, arrivals[:, ::stride, ::stride])

    def _arrivals(self, space):
        return space[: self.groups * (2 * self.nodes + 1) * (self.polar + 1) * self.columns]

    def apply(self, space):
        """What leaves the interface.

        Shape (groups, azimuths or columns, polar angles or rows, replicates, slots, channels of a group).
        ``space`` is overwritten, and holds what is returned.
        """
        there, here = space
        azimuths = (self.groups, 2 * self.nodes + 1)
        arrivals = self._arrivals(there).reshape(*azimuths, -1)
        found = self._arrivals(here).reshape(arrivals.shape)
        for g in range(self.groups):
            to_coefficients(self.matrix, arrivals[g], found[g])
        for stage, (kernel, rows) in enumerate(zip(self.kernels, self.rows, strict=True)):
            found = found.reshape(*azimuths, -1, self.columns)
            if stage == 1:
                tolled = found.reshape(*found.shape[:3], -1, self.toll.shape[-1])
                tolled *= self.toll[:, :, :, None]
            shape = (*azimuths, len(rows), self.columns)
            product = there[: math.prod(shape)].reshape(shape)
            np.matmul(kernel, found, out=product)
            there, here, found = here, there, product
        values = there[: self.groups * self.azimuths * len(self.rows[-1]) * self.columns]
        values = values.reshape(self.groups, self.azimuths, -1)
        for g in range(self.groups):
            to_values(self.to_azimuths, found[g].reshape(2 * self.nodes + 1, -1), values[g])
        return values.reshape(self.groups, self.azimuths, len(self.rows[-1]), self.replicates, self.slots, -1)

    @property
    def multiplications(self):
        """Of one call of `apply`."""
        azimuths = 2 * self.nodes + 1
        kernels_of = sum(len(rows) * polar for rows, polar in zip(self.rows, self._incoming, strict=True))
        series = (azimuths * self._incoming[0] + self.azimuths * len(self.rows[-1])) // 2
        return self.groups * self.columns * azimuths * (kernels_of + series)

    @property
    def memory(self):
        """Bytes that are shared, and bytes of a workspace with what `apply` needs besides."""
        azimuths = 2 * self.nodes + 1
        groups = [self.groups, 1][: len(self.rows)]
        sizes = list(zip(groups, self.rows, self._incoming, strict=True))
        tables = sum(g * azimuths * len(rows) * polar for g, rows, polar in sizes)
        # The table of a block of rows, its nodes combined, its coefficients, and halves of them.
        making = 4 * azimuths * max(rows.nodes_of(kernels.BLOCK) * polar for _, rows, polar in sizes)
        series = 3 * azimuths * azimuths
        own = 3 * self.groups * azimuths * self._most_polar * self.columns
        return _NUMBER * (tables + making + series), _NUMBER * own


def order_ahead(plan, variant, side):
    """Number of the slot of light that leaves, less its order on arrival at the interface."""
    last_event = 1 if side == UP or variant.interface == 0 else 0
    return last_event - int(plan.slots[side, 2])
