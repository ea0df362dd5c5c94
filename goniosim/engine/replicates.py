"""Means and standard errors from independent replicates of slices, all of one incident direction.

Within a round the scatter of the replicates is followed by Welford's recurrence, so that nothing is kept of a single
one but its sums over blocks of cells. Rounds are added up with weights that were fixed before they were run, and so
their variances add.
"""

import numpy as np

from .blocks import Blocks
from .mending import mended
from .rounds import FEWEST_REPLICATES, REPLICATES


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
    mends : bool
        Whether the variance of cells with few hits is mended.

    Attributes
    ----------
    paths : int
        Light paths in the finished rounds.
    batches : ndarray, shape (B, views, channels, block rows, block columns)
        Energies of blocks of cells, folded: means with the rounds' weights of the r-th replicates of all rounds. What was
        interrupted counts only if there is nothing else.
    """

    def __init__(self, views, shape, columns, mends):
        self._views = views
        self._columns = columns
        self._mends = mends
        self._blocks = Blocks(shape[1], shape[2], columns)
        slices, sums = (len(views), *shape), (len(views), shape[0])
        self._cells, self._totals = _Sum(slices), _Sum(sums)
        self._effective = np.zeros(slices)
        self.batches = np.zeros((REPLICATES, *sums, *self._blocks.shape))
        self._batches_weight = 0.0
        self.paths = 0
        self._begin(0)

    def _begin(self, size):
        self._size = size
        self._round, self._round_totals = Welford(), Welford()
        self._round_blocks = []

    @property
    def weight(self):
        """Sum of the weights of the finished rounds."""
        return self._cells.weight

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
        if number != self._round.count or size != self._size:
            return
        views = np.stack([slots[view].sum(axis=0) for view in self._views])
        blocks = self._blocks.sums(views)
        self._round.add(views)
        self._round_totals.add(blocks.sum(axis=(2, 3)) * self._blocks.fold)
        self._round_blocks.append(blocks)

    def finish_round(self):
        """Add the round up; one of too few replicates is dropped, unless there is no other."""
        count = self._round.count
        if count >= FEWEST_REPLICATES or (count >= 2 and self.weight == 0.0):
            self._add_batches()
            weight = float(count * self._size)
            variance = self._round.variance_of_mean()
            if self._mends:
                variance = mended(self._round.mean, variance)
            self._cells.add(self._round.mean, variance, weight)
            self._totals.add(self._round_totals.mean, self._round_totals.variance_of_mean(), weight)
            self._effective += self._round.effective_number()
            self.paths += count * self._size
        self._begin(0)

    def _add_batches(self):
        blocks = np.stack(self._round_blocks)
        if self.weight == 0.0:
            self.batches = self.batches[: len(blocks)]
        if len(blocks) == len(self.batches):
            self._batches_weight += self._size
            self.batches += self._size / self._batches_weight * (blocks - self.batches)

    def slices(self, view):
        """Energy, its standard error and the effective number of replicates of a view.

        Returns
        -------
        ndarray, each of shape (channels, rows, columns)
        """
        energy, variance, number = (
            unfold(each[view], self._columns) for each in (self._cells.mean, self._cells.variance, self._effective)
        )
        # Cosine series and cubic stencils may go below zero where there is next to nothing.
        return np.maximum(energy, 0.0), np.sqrt(variance), number

    def total(self, view):
        """Energy of all cells of a view, and its standard error; each of shape (channels,)."""
        return self._totals.mean[view], np.sqrt(self._totals.variance[view])


class Welford:
    """Mean and squared deviations of arrays, one by one."""

    def __init__(self):
        self.count = 0
        self.mean = None
        self._squares = None

    def add(self, values):
        """Take in an array."""
        self.count += 1
        if self.mean is None:
            self.mean, self._squares = values.copy(), np.zeros_like(values)
            return
        step = values - self.mean
        self.mean += step / self.count
        self._squares += step * (values - self.mean)

    def variance_of_mean(self):
        """Squared standard error of the mean."""
        return self._squares / (self.count * (self.count - 1.0))

    def effective_number(self):
        """How many equal values would scatter so: (sum)^2 / sum of squares; 0 where all are 0."""
        square = self.count * self.mean**2
        return np.divide(self.count * square, self._squares + square, out=np.zeros_like(square), where=square > 0.0)


class _Sum:
    """A mean of means with weights, and its variance."""

    def __init__(self, shape):
        self.weight = 0.0
        self.mean = np.zeros(shape)
        self.variance = np.zeros(shape)

    def add(self, mean, variance, weight):
        self.weight += weight
        share = weight / self.weight
        self.mean += share * (mean - self.mean)
        self.variance *= (1.0 - share) ** 2
        self.variance += share**2 * variance


def unfold(half, columns):
    """Slices of all columns from those that tell all."""
    return half if half.shape[-1] == columns else np.concatenate([half, half[..., ::-1]], axis=-1)
