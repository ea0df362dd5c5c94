"""What no node of a rule sees: kinks that cut off an edge or a corner of a rectangle.

The nodes of a rule keep away from the border, so an arc on which a density has a kink can cut off a strip that all
of them miss: rules on the whole and on its parts then agree, and are wrong alike. Here the nodes of the four quarters
of a rectangle foretell the integrand at its corners and in the middle of its sides: all nodes together, and alone those
of the quarter in whose corner the point lies. The former are right to what the rules differ by if the integrand is
smooth, the latter are if it has a kink elsewhere. If both are wrong, then by what the nodes do not see.

The integrand is taken over the row coordinate: it vanishes at the pole of a slice, whatever the density does there.
"""

import numpy as np

from .._jit import kernel, stage
from .pool import BLOCK
from .rectangle import D_U, U, fill

# Corners and middles of the sides, along each side of a rectangle: all points of the lattice but the centre.
LATTICE = np.array([0.0, 0.5, 1.0])
_BORDER = np.array([0, 1, 2, 3, 5, 6, 7, 8])
POINTS = len(_BORDER)
# Row coordinate at which rectangles begin that begin at the pole, where nothing can be told.
_BESIDE_THE_POLE = 1e-12
# What a quarter adds at all points, and what it foretells alone in its four corners.
TOLD = POINTS + 4
# Of each point the quarters in whose corner it lies, one or two, and which corner that is.
_QUARTERS = np.array([[0, 0], [0, 1], [1, 1], [0, 2], [1, 3], [2, 2], [2, 3], [3, 3]])
_CORNERS = np.array([[0, 0], [1, 0], [1, 1], [2, 0], [3, 1], [2, 2], [3, 2], [3, 3]])


def weights_of(nodes):
    """Weights that extrapolate from the nodes in a quarter of the unit square.

    Parameters
    ----------
    nodes : ndarray, shape (n,)
        In [0, 1].

    Returns
    -------
    ndarray, shape (4, TOLD, n * n)
        Of values that are themselves relative to the area of the quarter.
    """
    both = np.concatenate([0.5 * nodes, 0.5 + 0.5 * nodes])
    joint = _extrapolation(both, LATTICE).reshape(len(LATTICE), 2, len(nodes))
    alone = np.einsum("pa,qb->pqab", *[_extrapolation(nodes, LATTICE[[0, -1]])] * 2).reshape(4, -1)
    quarters = [
        np.concatenate([np.einsum("pa,qb->pqab", joint[:, i], joint[:, j]).reshape(9, -1)[_BORDER], alone])
        for i in range(2)
        for j in range(2)
    ]
    return 4.0 * np.array(quarters)


def _extrapolation(nodes, at):
    """Values of Lagrange's polynomials, shape (points, nodes)."""
    factors = np.array([1.0 / np.prod(x - np.delete(nodes, i)) for i, x in enumerate(nodes)])
    terms = factors / (at[:, None] - nodes)
    return terms / terms.sum(axis=1, keepdims=True)


@kernel
def foretell(values, weight, parts, nodes, weights, quarter, start, told):
    """What each quarter foretells of the integrand, from the values at all nodes.

    Parameters
    ----------
    values : ndarray, shape (channels, m * n * n)
    weight : ndarray, shape (m * n * n,)
    parts : ndarray, shape (parts, 4)
    nodes : ndarray, shape (n,)
    weights : ndarray, shape (4, TOLD, n * n)
    quarter : ndarray of int, shape (parts,)
        0 to 3, or -1 of a part that is not a quarter.
    start : int
        Number of the first part.
    told : ndarray, shape (parts, channels, TOLD), out
    """
    n = nodes.shape[0]
    count = n * n
    f = np.empty(count)
    scale = np.empty(n)
    for k in range(weight.shape[0] // count):
        place = quarter[start + k]
        if place < 0:
            continue
        table = weights[place]
        low = parts[start + k, U]
        high = low + parts[start + k, D_U]
        middle = high if place < 2 else low
        # A division within the product would be rounded in one of two ways, where that becomes SIMD code or not.
        for i in range(n):
            scale[i] = middle / (low + (high - low) * nodes[i])
        for c in range(values.shape[0]):
            _integrand(values[c, k * count :], weight[k * count :], scale, f)
            row = told[start + k, c]
            # Four at a time: one sum alone would wait for itself.
            for p in range(0, TOLD, 4):
                a = 0.0
                b = 0.0
                d = 0.0
                e = 0.0
                for i in range(count):
                    a += table[p, i] * f[i]
                    b += table[p + 1, i] * f[i]
                    d += table[p + 2, i] * f[i]
                    e += table[p + 3, i] * f[i]
                row[p] = a
                row[p + 1] = b
                row[p + 2] = d
                row[p + 3] = e


@stage
def _integrand(values, weight, scale, f):
    """Values of the integrand at the nodes of a quarter, over the row coordinate."""
    n = scale.shape[0]
    for i in range(n):
        factor = scale[i]
        here = f[i * n : (i + 1) * n]
        value = values[i * n : (i + 1) * n]
        area = weight[i * n : (i + 1) * n]
        for j in range(n):
            here[j] = value[j] * area[j] * factor


def retell(density, grid, rule, rectangles, pool):
    """What the quarters foretell of what the horizon leaves of rectangles: their parts are others.

    Parameters
    ----------
    density, grid, rule, rectangles, pool
        As in `rule.evaluate`.

    Returns
    -------
    ndarray, shape (4 * n, channels, TOLD)
    """
    told = np.empty((4 * len(rectangles), density.channels, TOLD))
    both = np.concatenate([0.5 * rule.nodes, 0.5 + 0.5 * rule.nodes])
    n = len(rule.nodes)
    low, high = rectangles.copy(), rectangles.copy()
    low[:, D_U] *= 0.5
    high[:, D_U] *= 0.5
    high[:, U] += high[:, D_U]
    parts = np.stack([low, low, high, high], axis=1).reshape(-1, 4)
    quarter = np.tile(np.arange(4, dtype=np.int8), len(rectangles))
    step = max(1, BLOCK // (4 * n * n))

    def by_quarter(array, count):
        return np.moveaxis(array.reshape(-1, count, 2, n, 2, n), 4, 3).reshape(len(array), -1)

    def work(start):
        part = rectangles[start : start + step]
        x, y, z, weight = np.empty((4, len(part) * 4 * n * n))
        values = np.empty((density.channels, len(x)))
        fill(grid.code, grid.light, part, both, x, y, z, weight)
        density.kernel(density.tables, density.light, x, y, z, values)
        values, weight = by_quarter(values, len(part)), 0.25 * by_quarter(weight[None], len(part))[0]
        foretell(values, weight, parts, rule.nodes, rule.border, quarter, 4 * start, told)

    pool.in_blocks(work, len(rectangles), step)
    return told


def unseen(density, grid, rule, rectangles, told, first, pool):
    """Energy that the nodes of the quarters of rectangles may not see, at most, in a strip along one side.

    Parameters
    ----------
    density, grid, rule, rectangles, pool
        As in `rule.evaluate`.
    told : ndarray, shape (parts, channels, TOLD)
        Of `rule.evaluate`.
    first : ndarray of int, shape (n,)
        The first quarter of each rectangle.

    Returns
    -------
    ndarray, shape (channels, n)
    """
    # Not quite at the pole, where nothing can be told.
    rectangles = np.maximum(rectangles, [_BESIDE_THE_POLE, 0.0, 0.0, 0.0])
    largest = np.empty((density.channels, len(rectangles)))
    step = max(1, BLOCK // 9)

    def work(start):
        part = rectangles[start : start + step]
        x, y, z, weight = np.empty((4, len(part) * 9))
        values = np.empty((len(largest), len(x)))
        fill(grid.code, grid.light, part, LATTICE, x, y, z, weight)
        density.kernel(density.tables, density.light, x, y, z, values)
        _surprise(values, weight, rectangles, told, first, start, largest)

    pool.in_blocks(work, len(rectangles), step)
    return rule.unseen * largest


@kernel
def _surprise(values, weight, rectangles, told, first, start, out):
    """The least wrong of what was foretold, at the point of the border where that is most.

    Parameters
    ----------
    values : ndarray, shape (channels, m * 9)
        At the lattices of m rectangles.
    weight : ndarray, shape (m * 9,)
    rectangles : ndarray, shape (n, 4)
    told : ndarray, shape (parts, channels, TOLD)
    first : ndarray of int, shape (n,)
        The first quarter of each rectangle.
    start : int
        Number of the first rectangle.
    out : ndarray, shape (channels, n)
    """
    for k in range(weight.shape[0] // 9):
        at = first[start + k]
        low = rectangles[start + k, U]
        height = rectangles[start + k, D_U]
        for c in range(values.shape[0]):
            largest = 0.0
            for p in range(POINTS):
                here = 9 * k + _BORDER[p]
                scale = (low + 0.5 * height) / (low + height * LATTICE[_BORDER[p] // 3])
                f = values[c, here] * weight[here] * scale
                joint = told[at, c, p] + told[at + 1, c, p] + told[at + 2, c, p] + told[at + 3, c, p]
                one = told[at + _QUARTERS[p, 0], c, POINTS + _CORNERS[p, 0]]
                other = told[at + _QUARTERS[p, 1], c, POINTS + _CORNERS[p, 1]]
                largest = max(largest, min(abs(f - joint), abs(f - one), abs(f - other)))
            out[c, start + k] = largest
