"""Interpolation between nodes in many directions at a time, of four numbers at a time.

The stencils are those of `nodes`. Their weights are found in lockstep; a look at the table is one of its own, since
sixteen nodes of four neighbouring numbers each are read faster than 64 numbers from all over it.
"""

from ..._jit import intrinsic, ir, stage, types
from .nodes import cubic, mirrored, place

# Numbers that are interpolated at once.
LANES = 4
# Rows for a stencil: weights of four polar angles, then of four azimuths.
WEIGHTS = 8
AROUND = 4

_LONG, _INT = ir.IntType(64), ir.IntType(32)
_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_FUSED = ("contract", "nsz")


def padded(count):
    """Numbers that a node of a table has room for, of which ``count`` are used."""
    return -(-count // LANES) * LANES


@stage
def find_stencils(x, y, z, n, values, weights, nodes):
    """Stencils around ``n`` directions.

    Parameters
    ----------
    x, y, z : ndarray, shape (>= n,)
        Unit vectors, z >= 0.
    n : int
    values : ndarray, shape (azimuths, polar angles, padded number)
    weights : ndarray, shape (WEIGHTS, >= n)
        Overwritten.
    nodes : ndarray of int64, shape (4, >= n)
        Overwritten: where in the table the four nodes of each azimuth begin.
    """
    polar = values.shape[1]
    lanes = values.shape[2]
    _find_places(x, y, z, n, polar - 1, weights[0], weights[AROUND])
    for s in range(4):
        _find_azimuths(weights[AROUND], n, s, 2 * (polar - 1), polar * lanes, nodes[s])
    _weigh_azimuths(n, 2 * (polar - 1), weights[4], weights[5], weights[6], weights[7])
    for s in range(4):
        _add_polar_angles(weights[0], n, polar - 4, lanes, nodes[s])
    _weigh_polar_angles(n, polar - 4, weights[0], weights[1], weights[2], weights[3])


@stage
def _find_places(x, y, z, n, nodes, u, v):
    for i in range(n):
        u[i], v[i] = place(x[i], y[i], z[i], nodes, 2 * nodes)


@stage
def _find_azimuths(v, n, s, last, pitch, nodes):
    for i in range(n):
        first, _, _, _, _ = cubic(v[i], -1, last - 1)
        nodes[i] = mirrored(first + s, last) * pitch


@stage
def _weigh_azimuths(n, last, b0, b1, b2, b3):
    for i in range(n):
        _, b0[i], b1[i], b2[i], b3[i] = cubic(b0[i], -1, last - 1)


@stage
def _add_polar_angles(u, n, highest, pitch, nodes):
    for i in range(n):
        first, _, _, _, _ = cubic(u[i], 0, highest)
        nodes[i] += first * pitch


@stage
def _weigh_polar_angles(n, highest, a0, a1, a2, a3):
    for i in range(n):
        _, a0[i], a1[i], a2[i], a3[i] = cubic(a0[i], 0, highest)


@stage
def interpolate(values, weights, nodes, n, found):
    """Values in ``n`` directions.

    Parameters
    ----------
    values, weights, nodes, n
        As `find_stencils` takes and leaves them.
    found : ndarray, shape (padded number / LANES, >= n, LANES)
        Overwritten.
    """
    a0, a1, a2, a3 = weights[0], weights[1], weights[2], weights[3]
    b0, b1, b2, b3 = weights[4], weights[5], weights[6], weights[7]
    n0, n1, n2, n3 = nodes[0], nodes[1], nodes[2], nodes[3]
    pitch = values.shape[2]
    for quad in range(pitch // LANES):
        start = quad * LANES
        target = found[quad]
        for i in range(n):
            begins = (n0[i] + start, n1[i] + start, n2[i] + start, n3[i] + start)
            _look(values, pitch, begins, (a0[i], a1[i], a2[i], a3[i]), (b0[i], b1[i], b2[i], b3[i]), target, i * LANES)


@intrinsic
def _look(typingctx, values, pitch, begins, polar, around, found, place):
    """Write the weighted mean of 4 x 4 nodes, as lanes, to a place in ``found``; places are counted through."""

    def codegen(context, builder, signature, args):
        _, pitch, begins, polar, around, _, place = args
        total = ir.Constant(_VECTOR, [0.0] * LANES)
        for r in range(4):
            ring = ir.Constant(_VECTOR, [0.0] * LANES)
            for s in range(4):
                node = builder.add(builder.extract_value(begins, s), builder.mul(pitch, _LONG(r)))
                lanes = builder.load(_lanes_at(context, builder, signature, args, 0, node))
                lanes.align = 8
                ring = _add(builder, ring, lanes, builder.extract_value(around, s))
            total = _add(builder, total, ring, builder.extract_value(polar, r))
        builder.store(total, _lanes_at(context, builder, signature, args, 5, place), align=8)
        return context.get_dummy_value()

    return types.void(values, types.int64, begins, polar, around, found, types.int64), codegen


def _lanes_at(context, builder, signature, args, array, place):
    """Pointer to the lanes at a place of the array that is argument ``array``."""
    data = context.make_array(signature.args[array])(context, builder, args[array]).data
    return builder.bitcast(builder.gep(data, [place]), _VECTOR.as_pointer())


def _add(builder, total, lanes, weight):
    """``total + weight * lanes``."""
    first = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), weight, _INT(0))
    weights = builder.shuffle_vector(first, first, ir.Constant(ir.VectorType(_INT, LANES), [0] * LANES))
    return builder.fadd(total, builder.fmul(weights, lanes, flags=_FUSED), flags=_FUSED)
