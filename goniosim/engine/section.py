"""What replicates of one size add up to: their means, their scatter, and each one's sums over blocks of cells.

Replicates come in sections of `SECTION`. Each section is added up by itself and then joined to those before it, so
that the sums are the same to the last bit wherever its sections were made.
"""

import numpy as np

from .packing import array
from .welford import FoldedBlocks, Welford

SECTION = 8


class Section:
    """Running sums over replicates; a *view* is a sum of slots: a component or one of its orders.

    Parameters
    ----------
    views : list of slice
        Slots of each view.
    shape : tuple of int
        Distinct channels, rows, folded columns.
    columns : int
        Columns of a whole slice.

    Attributes
    ----------
    cells, totals : Welford
        Over slices [view, channel, row, folded column], and over their sums [view, channel].
    blocks : list of ndarray, shape (views, channels, row blocks, column blocks)
        Of each replicate.
    """

    def __init__(self, views, shape, columns):
        self._views, self._shape = views, shape
        self._blocks_of = FoldedBlocks(shape[1], columns, shape[2])
        self.cells, self.totals, self.blocks = Welford(), Welford(), []

    @property
    def count(self):
        """Replicates."""
        return self.cells.count

    def add(self, slots):
        """Take in a replicate, as energies [slot, channel, row, folded column]."""
        views = (
            slots
            if len(slots) == len(self._views) == 1
            else np.stack([slots[view].sum(axis=0) for view in self._views])
        )
        blocks = self._blocks_of(views)
        self.cells.add(views)
        self.totals.add(blocks.sum(axis=(2, 3)))
        self.blocks.append(blocks)

    def join(self, other):
        """Take in a section, which is not to be used any more."""
        self.cells.join(other.cells)
        self.totals.join(other.totals)
        self.blocks += other.blocks

    def state(self):
        """As a tree for `packing.pack`."""
        return {"cells": self.cells.state(), "totals": self.totals.state(), "blocks": self.blocks}

    def restore(self, state):
        """Go on from such a tree."""
        slices = (len(self._views), *self._shape)
        self.cells.restore(state["cells"], slices)
        self.totals.restore(state["totals"], slices[:2])
        self.blocks = [array(values, self.shape_of_blocks) for values in state["blocks"]]
        if not self.cells.count == self.totals.count == len(self.blocks):
            raise ValueError("not the state of this run: numbers of replicates that contradict each other")

    @property
    def shape_of_blocks(self):
        """Shape of the sums over blocks of one replicate."""
        return self._blocks_of.shape((len(self._views), *self._shape))
