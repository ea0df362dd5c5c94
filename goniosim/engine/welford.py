"""Running means, squared deviations and block sums of folded slices, each in one pass."""

import numpy as np

from .._jit import kernel
from ..sums import BLOCKS, block_starts
from .packing import array


class Welford:
    """Mean and squared deviations of arrays, one by one."""

    def __init__(self):
        self.count = 0
        self.mean = None
        self._squares = None

    def add(self, values):
        """Take in an array."""
        if self.mean is None:
            self.mean, self._squares = np.zeros(values.shape), np.zeros(values.shape)
        self.count += 1
        _take_in(np.ascontiguousarray(values).reshape(-1), self.count, self.mean.reshape(-1), self._squares.reshape(-1))

    def join(self, other):
        """Take in what another one has taken in, after what this one has; the other is not to be used any more.

        Chan, Golub and LeVeque, Updating formulae and a pairwise algorithm for computing sample variances, 1979.
        """
        if other.count == 0:
            return
        if self.count == 0:
            self.count, self.mean, self._squares = other.count, other.mean, other._squares
            return
        flat = (each.reshape(-1) for each in (self.mean, self._squares, other.mean, other._squares))
        _join(self.count, other.count, *flat)
        self.count += other.count

    def state(self):
        """As a tree for `packing.pack`."""
        return [self.count, self.mean, self._squares]

    def restore(self, state, shape):
        """Go on from such a tree, of arrays of some shape."""
        self.count, mean, squares = state
        if self.count:
            self.mean, self._squares = array(mean, shape), array(squares, shape)

    def variance_of_mean(self):
        """Squared standard error of the mean."""
        return self._squares / (self.count * (self.count - 1.0))


class FoldedBlocks:
    """Sums over the blocks of `goniosim.sums.block_sums`, of slices of which only a folded half is there.

    Parameters
    ----------
    rows, columns : int
        Of a whole slice.
    width : int
        Columns that tell all of it, see `plan.Plan.width`.
    """

    def __init__(self, rows, columns, width):
        self._rows, self._columns = (
            np.append(block_starts(n, most), n) for n, most in zip((rows, columns), BLOCKS, strict=True)
        )
        self._width = width

    def shape(self, half):
        """Shape of the sums of folded slices of some shape."""
        return (*half[:-2], len(self._rows) - 1, len(self._columns) - 1)

    def __call__(self, half):
        """Sums of ``half[..., row, folded column]``, shape (..., row blocks, column blocks)."""
        rows, width = half.shape[-2:]
        found = np.empty(self.shape(half.shape))
        flat = np.ascontiguousarray(half).reshape(-1, rows, width)
        _block_sums(flat, self._rows, self._columns, np.empty(self._columns[-1]), found.reshape(-1, *found.shape[-2:]))
        return found


@kernel
def _take_in(values, count, mean, squares):
    share = 1.0 / count
    for i in range(values.shape[0]):
        step = values[i] - mean[i]
        mean[i] += step * share
        squares[i] += step * (values[i] - mean[i])


@kernel
def _join(count, more, mean, squares, mean_of_more, squares_of_more):
    share = more / (count + more)
    weight = count * share
    for i in range(mean.shape[0]):
        step = mean_of_more[i] - mean[i]
        mean[i] += step * share
        squares[i] += squares_of_more[i] + step * step * weight


@kernel
def _block_sums(half, rows, columns, line, found):
    width = half.shape[2]
    last = line.shape[0] - 1
    for n in range(half.shape[0]):
        for p in range(found.shape[1]):
            for j in range(width):
                line[j] = half[n, rows[p], j]
            for i in range(rows[p] + 1, rows[p + 1]):
                for j in range(width):
                    line[j] += half[n, i, j]
            for j in range(width, line.shape[0]):
                line[j] = line[last - j]
            for q in range(found.shape[2]):
                total = 0.0
                for j in range(columns[q], columns[q + 1]):
                    total += line[j]
                found[n, p, q] = total
