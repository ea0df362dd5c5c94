"""Means and standard errors from independent replicates of slices, all of one incident direction.

Within a round the scatter of the replicates is followed section by section, so that nothing is kept of a single one
but its sums over blocks of cells. Rounds are added up with weights that were fixed before they were run, and so their
variances add.
"""

from functools import partial

import numpy as np

from ..sums import block_sums
from .mending import mended
from .packing import array
from .rounds import FEWEST_REPLICATES, REPLICATES
from .section import SECTION, Section


class Replicates:
    """Running sums; a *view* is a sum of slots: a component or one of its orders.

    Parameters
    ----------
    views : list of slice
        Slots of each view.
    shape : tuple of int
        Distinct channels, rows, folded columns.
    columns : int
        Columns of a whole slice.
    alike : tuple of int or None
        Rows and columns to each side by which the variance of cells with few hits is mended; None if it is not.

    Attributes
    ----------
    paths : int
        Light paths in the finished rounds.
    count : int
        Replicates in the finished rounds.
    """

    def __init__(self, views, shape, columns, alike):
        self._columns = columns
        self._empty = partial(Section, views, shape, columns)
        self._alike = alike
        slices, sums = (len(views), *shape), (len(views), shape[0])
        self._cells, self._totals = _Sum(slices), _Sum(sums)
        self.paths = self.count = 0
        self._begin(0)
        self._batches = np.zeros((REPLICATES, *self._round.shape_of_blocks))

    def _begin(self, size):
        self._size = size
        self._round, self._section = self._empty(), self._empty()

    @property
    def weight(self):
        """Sum of the weights of the finished rounds."""
        return self._cells.weight

    @property
    def gathered(self):
        """Whether there would be something to keep."""
        return self.weight > 0.0 or self._round.count + self._section.count >= 2

    def add(self, number, size, slots):
        """Take in the ``number``-th replicate of a round.

        Parameters
        ----------
        number : int
        size : int
            Its light paths.
        slots : ndarray, shape (slots, channels, rows, folded columns)
        """
        if number == 0:
            self._begin(size)
        # After a stop, replicates count only as far as none is missing before them.
        if number != self._round.count + self._section.count or size != self._size:
            return
        self._section.add(slots)
        if self._section.count == SECTION:
            self._close()

    def join(self, size, state):
        """Take in a section of a round that was added up elsewhere.

        Parameters
        ----------
        size : int
            Light paths of a replicate.
        state : tree
            As of `Section.state`.
        """
        self._close()
        if self._round.count == 0:
            self._begin(size)
        section = self._empty()
        section.restore(state)
        self._round.join(section)

    def _close(self):
        self._round.join(self._section)
        self._section = self._empty()

    def finish_round(self):
        """Add the round up; one of too few replicates is dropped, unless there is no other."""
        self._close()
        count = self._round.count
        if count >= FEWEST_REPLICATES or (count >= 2 and self.weight == 0.0):
            weight = float(count * self._size)
            cells, totals = self._round.cells, self._round.totals
            variance = cells.variance_of_mean()
            if self._alike is not None:
                variance = mended(cells.mean, variance, self._alike)
            self._cells.add(cells.mean, variance, weight)
            self._totals.add(totals.mean, totals.variance_of_mean(), weight)
            self._batches += weight / self.weight * (_as_many(np.stack(self._round.blocks)) - self._batches)
            self.paths += count * self._size
            self.count += count
        self._begin(0)

    def state(self):
        """What has been added up, as a tree for `packing.pack`."""
        return {
            "sums": [self._cells.state(), self._totals.state()],
            "batches": self._batches,
            "paths": self.paths,
            "count": self.count,
            "size": self._size,
            "round": self._round.state(),
            "section": self._section.state(),
        }

    def restore(self, state):
        """Go on from such a tree."""
        for each, values in zip((self._cells, self._totals), state["sums"], strict=True):
            each.restore(values)
        self.paths, self.count, self._size = (int(state[name]) for name in ("paths", "count", "size"))
        self._begin(self._size)
        self._batches = array(state["batches"], self._batches.shape)
        self._round.restore(state["round"])
        self._section.restore(state["section"])

    def slices(self, view):
        """Energy and its standard error of a view, each of shape (channels, rows, columns)."""
        energy, variance = (unfold(each[view], self._columns) for each in (self._cells.mean, self._cells.variance))
        # Cosine series and cubic stencils may go below zero where there is next to nothing.
        return np.maximum(energy, 0.0), np.sqrt(variance)

    def total_stderr(self, view):
        """Standard error of the energy of all cells of a view, shape (channels,)."""
        return np.sqrt(self._totals.variance[view])

    def batches(self, view):
        """Energies of blocks of cells by the r-th replicates of all rounds, as `goniosim.result.Component.batches`.

        Returns
        -------
        ndarray, shape (REPLICATES, channels, row blocks, column blocks)
        """
        batches = self._batches[:, view]
        return batches + (block_sums(self.slices(view)[0]) - batches.mean(axis=0))


def _as_many(found):
    """As many values as replicates of a whole round, with the same mean; those of an interrupted one come in again."""
    again = found[np.arange(REPLICATES) % len(found)]
    return again + (found.mean(axis=0) - again.mean(axis=0))


class _Sum:
    """A mean of means with weights, and its variance."""

    def __init__(self, shape):
        self.weight = 0.0
        self.mean = np.zeros(shape)
        self.variance = np.zeros(shape)

    def state(self):
        return [self.weight, self.mean, self.variance]

    def restore(self, state):
        weight, mean, variance = state
        self.weight = float(weight)
        self.mean, self.variance = array(mean, self.mean.shape), array(variance, self.mean.shape)

    def add(self, mean, variance, weight):
        self.weight += weight
        share = weight / self.weight
        self.mean += share * (mean - self.mean)
        self.variance *= (1.0 - share) ** 2
        self.variance += share**2 * variance


def unfold(half, columns):
    """Slices of all columns from those that tell all."""
    return half if half.shape[-1] == columns else np.concatenate([half, half[..., ::-1]], axis=-1)
