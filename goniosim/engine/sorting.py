"""A batch sorted into the rays that were reflected and those that went through, each kept in their order.

`sort` finds out which go where, `move` moves one field of one sort. Where the processor can squeeze chosen lanes
of a vector together, eight rays are moved at once (`by_lanes`); elsewhere one by one, by lists of their places
(`by_places`), since compilers make up for the missing instruction slowly. The outcome is the same.
"""

from collections import namedtuple

import numpy as np

from .._jit import intrinsic, ir, stage, types
from .._jit.target import target

# Rays moved at once; a target row needs so much room behind its last ray.
LANES = 8
_HALF_WORD = np.uint64(32)
_LOW_HALF = np.uint64(0xFFFFFFFF)
_ROW = types.Array(types.float64, 1, "C")
_BYTE, _LONG = ir.IntType(8), ir.IntType(64)
_VECTOR, _MASK = ir.VectorType(ir.DoubleType(), LANES), ir.VectorType(ir.IntType(1), LANES)


@stage
def _list_places(gain, transmitted, n, steps, reflected, through):
    """List the places of both sorts of rays; returns how many there are of each.

    Every ray is written to the end of both lists; its step moves the end of one of them, or
    of none. Both ends are halves of one number, so that the loop that cannot be vectorised does
    a single addition.
    """
    for i in range(n):
        alive = 1 if gain[i] > 0.0 else 0
        crossed = alive if transmitted[i] > 0.0 else 0
        steps[i] = (np.uint64(crossed) << _HALF_WORD) | np.uint64(alive - crossed)
    ends = np.uint64(0)
    for i in range(n):
        reflected[ends & _LOW_HALF] = i
        through[ends >> _HALF_WORD] = i
        ends += steps[i]
    return np.int64(ends & _LOW_HALF), np.int64(ends >> _HALF_WORD)


@stage
def _move_places(source, n, places, count, row, start):
    """Move the ``count`` rays of a list to ``row``, from ``start`` on."""
    row = row[start : start + count]
    if count == n:
        for i in range(n):
            row[i] = source[i]
    else:
        for i in range(count):
            row[i] = source[places[i]]


@stage
def _mark_lanes(gain, transmitted, n, steps, reflected, through):
    """As `_list_places`, but of every eight rays: a bit for each that is chosen, and how many come before."""
    n_reflected = 0
    n_through = 0
    for first in range(0, n, LANES):
        present = (1 << min(LANES, n - first)) - 1
        alive = _positive_lanes(gain, first) & present
        crossed = _positive_lanes(transmitted, first) & alive
        reflected[first] = alive - crossed
        reflected[first + 1] = n_reflected
        through[first] = crossed
        through[first + 1] = n_through
        n_reflected += _count_bits(alive - crossed)
        n_through += _count_bits(crossed)
    return n_reflected, n_through


@stage
def _move_lanes(source, n, marks, count, row, start):
    """Move the marked rays to ``row``, from ``start`` on; what follows them is overwritten, too."""
    for first in range(0, n, LANES):
        _squeeze(source, first, np.int64(marks[first]), row, start + np.int64(marks[first + 1]))


def _lanes_at(context, builder, signature, args, array):
    """Pointer to the lanes of a row; arguments ``array`` and the one after it are the row and the first place."""
    data = context.make_array(signature.args[array])(context, builder, args[array]).data
    return builder.bitcast(builder.gep(data, [args[array + 1]]), _VECTOR.as_pointer())


def _load(context, builder, signature, args, array):
    vector = builder.load(_lanes_at(context, builder, signature, args, array))
    vector.align = 8
    return vector


@intrinsic
def _positive_lanes(typingctx, row, first):
    """Bits of the lanes from ``first`` on that are positive."""

    def codegen(context, builder, signature, args):
        vector = _load(context, builder, signature, args, 0)
        positive = builder.fcmp_ordered(">", vector, ir.Constant(_VECTOR, [0.0] * LANES))
        return builder.zext(builder.bitcast(positive, _BYTE), _LONG)

    return types.int64(_ROW, types.int64), codegen


@intrinsic
def _count_bits(typingctx, bits):
    def codegen(context, builder, signature, args):
        return builder.ctpop(args[0])

    return types.int64(types.int64), codegen


@intrinsic
def _squeeze(typingctx, source, first, bits, row, start):
    """Write the marked lanes of ``source`` to ``row``, without gaps."""

    def codegen(context, builder, signature, args):
        vector = _load(context, builder, signature, args, 0)
        mask = builder.bitcast(builder.trunc(args[2], _BYTE), _MASK)
        kind = ir.FunctionType(_VECTOR, [_VECTOR, _MASK, _VECTOR])
        compress = builder.module.declare_intrinsic("llvm.experimental.vector.compress.v8f64", (), kind)
        squeezed = builder.call(compress, [vector, mask, ir.Constant(_VECTOR, ir.Undefined)])
        builder.store(squeezed, _lanes_at(context, builder, signature, args, 3), align=8)
        return context.get_dummy_value()

    return types.void(_ROW, types.int64, types.int64, _ROW, types.int64), codegen


_Way = namedtuple("_Way", "sort move")
by_places = _Way(_list_places, _move_places)
by_lanes = _Way(_mark_lanes, _move_lanes)
sort, move = by_lanes if "avx512f" in target()[1] else by_places
