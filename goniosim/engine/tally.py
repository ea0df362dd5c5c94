"""Histograms of what leaves the stack, with the second moments that the error bars need.

The statistical unit is the path, not the deposit: neighbouring deposits of one path in one cell
are added before they are squared. An estimator whose paths make several deposits hands them over
ordered by path and cell; the error bars then count every path once.
"""

import numpy as np

from .._jit import stage
from ..slices import cells_of
from .layout import WEIGHT, X, Y, Z


def record_length(channels):
    """Numbers per cell: sums, sums of squares and a count, rounded up to whole cache lines."""
    return 8 * -(-(2 * channels + 1) // 8)


@stage
def flush(side, exits, n, cells):
    """Deposit the first ``n`` rays of ``exits``, which left upwards (side 0) or downwards (1)."""
    parametrization, rows, columns, light, slots, paths, places, histogram, channels = cells
    cells_of(parametrization, exits[X], exits[Y], exits[Z], n, rows, columns, light, places)
    _choose_slot(exits, n, channels, slots[side], rows * columns, places)
    add_deposits(histogram, paths, places, exits, n, channels)


@stage
def _choose_slot(exits, n, channels, slot, size, places):
    first, count, first_order = slot
    if count == 1:
        for i in range(n):
            places[i] += first * size
    else:
        order = exits[WEIGHT + channels]
        for i in range(n):
            places[i] += (first + min(np.int64(order[i]) - first_order, count - 1)) * size


@stage
def add_deposits(histogram, paths, cells, batch, n, channels):
    """Add ``n`` deposits to the records of their cells.

    Parameters
    ----------
    histogram : ndarray, shape (cells, record_length(channels))
        Per cell: sums of the paths' energies, sums of their squares, number of paths.
    paths, cells : ndarray of int, shape (>= n,)
        Path and cell of each deposit; equal pairs stand next to each other.
    batch : ndarray, shape (fields, >= n)
        The weights are rows ``WEIGHT`` to ``WEIGHT + channels - 1``.
    """
    if channels == 3:
        _add_three(histogram, paths, cells, batch[WEIGHT], batch[WEIGHT + 1], batch[WEIGHT + 2], n)
        return
    i = 0
    while i < n:
        end = i + 1
        while end < n and cells[end] == cells[i] and paths[end] == paths[i]:
            end += 1
        record = histogram[cells[i]]
        for c in range(channels):
            energy = 0.0
            for j in range(i, end):
                energy += batch[WEIGHT + c, j]
            record[c] += energy
            record[channels + c] += energy * energy
        record[2 * channels] += 1.0
        i = end


@stage
def _add_three(histogram, paths, cells, red, green, blue, n):
    i = 0
    while i < n:
        r = red[i]
        g = green[i]
        b = blue[i]
        end = i + 1
        while end < n and cells[end] == cells[i] and paths[end] == paths[i]:
            r += red[end]
            g += green[end]
            b += blue[end]
            end += 1
        record = histogram[cells[i]]
        record[0] += r
        record[1] += g
        record[2] += b
        record[3] += r * r
        record[4] += g * g
        record[5] += b * b
        record[6] += 1.0
        i = end
