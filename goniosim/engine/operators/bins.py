"""Bins of arrivals: nodes in azimuth and polar angle, ``bins[slice, azimuth, polar angle * channels]``.

The four nodes in a row that a ray is spread over, with all their channels, are neighbours: as many vectors of four
numbers as there are channels. That is what takes time in the walk, and compilers do not find the vectors.
"""

from ..._jit import intrinsic, ir, kernel, stage, types
from .nodes import mirrored

_LANES = 4
# Polar angles whose arrivals, of all slices, stay in the nearest cache while `move_bins` fills them.
_BLOCK = 32
_ROW = types.Array(types.float64, 1, "C")
_VECTOR = ir.VectorType(ir.DoubleType(), _LANES)


@stage
def clear(bins):
    """Zeros, which are then near at hand."""
    for slot in range(bins.shape[0]):
        for j in range(bins.shape[1]):
            row = bins[slot, j]
            for i in range(row.shape[0]):
                row[i] = 0.0


@stage
def deposit(weights, slots, n, polar, around, first, bins):
    """Spread ``weights[channel, ray]`` over the nodes that `nodes.stencils` has found.

    Parameters
    ----------
    slots : ndarray
        Which slice of the bins each ray belongs to.
    polar, around, first : ndarray
        As `nodes.stencils` leaves them.
    bins : ndarray, shape (slices, azimuths, polar angles * channels)
        Added to.
    """
    if weights.shape[0] == 1:
        _deposit_one(weights[0], slots, n, polar, around, first, bins)
    elif weights.shape[0] == 2:
        _deposit_two(weights[0], weights[1], slots, n, polar, around, first, bins)
    elif weights.shape[0] == 3:
        _deposit_three(weights[0], weights[1], weights[2], slots, n, polar, around, first, bins)
    else:
        _deposit_many(weights, slots, n, polar, around, first, bins)


@stage
def _deposit_one(weight, slots, n, polar, around, first, bins):
    last = bins.shape[1] - 1
    for i in range(n):
        plane = bins[int(slots[i])]
        w = weight[i]
        a0, a1, a2, a3 = polar[0, i] * w, polar[1, i] * w, polar[2, i] * w, polar[3, i] * w
        at = first[0, i]
        for s in range(4):
            _add(plane[mirrored(first[1, i] + s, last)], at, around[s, i], a0, a1, a2, a3)


@stage
def _deposit_two(one, other, slots, n, polar, around, first, bins):
    last = bins.shape[1] - 1
    for i in range(n):
        plane = bins[int(slots[i])]
        v, w = one[i], other[i]
        a0, a1, a2, a3 = polar[0, i], polar[1, i], polar[2, i], polar[3, i]
        at = 2 * first[0, i]
        for s in range(4):
            row = plane[mirrored(first[1, i] + s, last)]
            b = around[s, i]
            _add(row, at, b, a0 * v, a0 * w, a1 * v, a1 * w)
            _add(row, at + 4, b, a2 * v, a2 * w, a3 * v, a3 * w)


@stage
def _deposit_three(red, green, blue, slots, n, polar, around, first, bins):
    last = bins.shape[1] - 1
    for i in range(n):
        plane = bins[int(slots[i])]
        u, v, w = red[i], green[i], blue[i]
        a0, a1, a2, a3 = polar[0, i], polar[1, i], polar[2, i], polar[3, i]
        at = 3 * first[0, i]
        for s in range(4):
            row = plane[mirrored(first[1, i] + s, last)]
            b = around[s, i]
            _add(row, at, b, a0 * u, a0 * v, a0 * w, a1 * u)
            _add(row, at + 4, b, a1 * v, a1 * w, a2 * u, a2 * v)
            _add(row, at + 8, b, a2 * w, a3 * u, a3 * v, a3 * w)


@stage
def _deposit_many(weights, slots, n, polar, around, first, bins):
    last = bins.shape[1] - 1
    channels = weights.shape[0]
    for i in range(n):
        plane = bins[int(slots[i])]
        for s in range(4):
            row = plane[mirrored(first[1, i] + s, last)]
            for r in range(4):
                share = around[s, i] * polar[r, i]
                at = (first[0, i] + r) * channels
                for c in range(channels):
                    row[at + c] += share * weights[c, i]


@intrinsic
def _add(typingctx, row, first, factor, a, b, c, d):
    """Add ``factor`` times four numbers to those of a row, from ``first`` on."""

    def codegen(context, builder, signature, args):
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        place = builder.bitcast(builder.gep(data, [args[1]]), _VECTOR.as_pointer())
        numbers = factors = ir.Constant(_VECTOR, ir.Undefined)
        for lane in range(_LANES):
            number = ir.Constant(ir.IntType(32), lane)
            numbers = builder.insert_element(numbers, args[3 + lane], number)
            factors = builder.insert_element(factors, args[2], number)
        product = builder.fmul(factors, numbers, flags=("contract",))
        before = builder.load(place)
        before.align = 8
        builder.store(builder.fadd(before, product, flags=("contract",)), place, align=8)
        return context.get_dummy_value()

    return types.void(_ROW, types.int64, *(5 * [types.float64])), codegen


@kernel
def move_bins(bins, factor, arrivals):
    """Fill ``arrivals[group, azimuth, polar, slice, channel]``.

    That is ``factor`` times ``bins[slice, azimuth, polar, group, channel]``.
    """
    angles, groups = bins.shape[2:4]
    for g in range(groups):
        for j in range(bins.shape[1]):
            for first in range(0, angles, _BLOCK):
                for r in range(bins.shape[0]):
                    _move(bins[r, j], g, first, min(first + _BLOCK, angles), factor, arrivals[g, j], r)


@stage
def _move(bins, g, first, last, factor, arrivals, r):
    if bins.shape[2] == 3:
        for i in range(first, last):
            arrivals[i, r, 0] = factor * bins[i, g, 0]
            arrivals[i, r, 1] = factor * bins[i, g, 1]
            arrivals[i, r, 2] = factor * bins[i, g, 2]
    elif bins.shape[2] == 2:
        for i in range(first, last):
            arrivals[i, r, 0] = factor * bins[i, g, 0]
            arrivals[i, r, 1] = factor * bins[i, g, 1]
    else:
        for c in range(bins.shape[2]):
            for i in range(first, last):
                arrivals[i, r, c] = factor * bins[i, g, c]
