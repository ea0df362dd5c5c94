"""Histograms of what leaves the stack, with the second moments that the error bars need.

The statistical unit is the path, which leaves once: every deposit is squared by itself.
"""

import math

import numpy as np

from .._jit import intrinsic, ir, stage, types
from ..slices import cells_of
from .layout import WEIGHT, X, Y, Z

_NUMBERS_PER_LINE = 8
# Deposits between the request for a record and its use: cells come in no order, and most records lie far away.
_AHEAD = 16


def record_length(channels):
    """Numbers per cell: sums, sums of squares and a count, rounded up to whole cache lines."""
    return _NUMBERS_PER_LINE * -(-(2 * channels + 1) // _NUMBERS_PER_LINE)


def empty_records(cells, channels):
    """Cleared records, shape (cells, record_length(channels)), each in cache lines of its own."""
    return aligned((cells, record_length(channels)))


def aligned(shape):
    """Zeros that begin with a cache line."""
    count = math.prod(shape)
    room = np.zeros(count + _NUMBERS_PER_LINE)
    first = -room.ctypes.data // room.itemsize % _NUMBERS_PER_LINE
    return room[first : first + count].reshape(shape)


@stage
def flush(side, exits, n, cells):
    """Deposit the first ``n`` rays of ``exits``, which left upwards (side 0) or downwards (1)."""
    parametrization, rows, columns, light, slots, places, histogram, channels = cells
    cells_of(parametrization, exits[X], exits[Y], exits[Z], n, rows, columns, light, places)
    _choose_slot(exits, n, channels, slots[side], rows * columns, places)
    add_deposits(histogram, places, exits, n, channels)


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
def add_deposits(histogram, cells, batch, n, channels):
    """Add ``n`` deposits to the records of their cells.

    Parameters
    ----------
    histogram : ndarray, shape (cells, record_length(channels))
        Per cell: sums of the paths' energies, sums of their squares, number of paths.
    cells : ndarray of int, shape (>= n,)
        Cell of each deposit.
    batch : ndarray, shape (fields, >= n)
        The weights are rows ``WEIGHT`` to ``WEIGHT + channels - 1``.
    """
    if channels == 3:
        _add_three(histogram, cells, batch[WEIGHT], batch[WEIGHT + 1], batch[WEIGHT + 2], n)
        return
    for i in range(n):
        _prefetch(histogram, np.int64(cells[min(i + _AHEAD, n - 1)]) * histogram.shape[1])
        record = histogram[cells[i]]
        for c in range(channels):
            energy = batch[WEIGHT + c, i]
            record[c] += energy
            record[channels + c] += energy * energy
        record[2 * channels] += 1.0


@stage
def _add_three(histogram, cells, red, green, blue, n):
    for i in range(n):
        _prefetch(histogram, np.int64(cells[min(i + _AHEAD, n - 1)]) * histogram.shape[1])
        r = red[i]
        g = green[i]
        b = blue[i]
        record = histogram[cells[i]]
        record[0] += r
        record[1] += g
        record[2] += b
        record[3] += r * r
        record[4] += g * g
        record[5] += b * b
        record[6] += 1.0


@intrinsic
def _prefetch(typingctx, array, index):
    """Ask for the cache line of an element of an array, counted through, that will soon be written to."""

    def codegen(context, builder, signature, args):
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        line = builder.gep(data, [args[1]])
        number = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [line.type, number, number, number])
        function = builder.module.declare_intrinsic("llvm.prefetch.p0", (), kind)
        # For writing, into the nearest cache, of data and not of code.
        builder.call(function, [line, number(1), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(array, types.int64), codegen
