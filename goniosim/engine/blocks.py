"""Sums over blocks of cells, as even in size as the cells allow."""

import numpy as np

ROWS, COLUMNS = 15, 30


class Blocks:
    """Blocks of a folded slice.

    Parameters
    ----------
    rows, width : int
        Rows and columns of the folded slice.
    columns : int
        Columns of the whole slice.

    Attributes
    ----------
    shape : tuple of int
        Block rows and block columns.
    fold : int
        Times that a cell of the folded slice stands in the whole one.
    """

    def __init__(self, rows, width, columns):
        self.fold = 1 if width == columns else 2
        self._rows = _starts(rows, ROWS)
        self._columns = _starts(width, COLUMNS // self.fold)
        self.shape = len(self._rows), len(self._columns)

    def sums(self, cells):
        """Sums over the blocks of arrays [.., rows, folded columns]."""
        return np.add.reduceat(np.add.reduceat(cells, self._columns, axis=-1), self._rows, axis=-2)


def _starts(length, most):
    """First number in each of up to ``most`` pieces of a row."""
    n = min(length, most)
    return np.array([length * i // n for i in range(n)])
