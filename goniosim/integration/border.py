"""What no node of a rule sees: kinks that cut off an edge or a corner of a rectangle.

The nodes of a rule keep away from the border, so an arc on which a density has a kink can cut off a strip that all
of them miss: rules on the whole and on its parts then agree, and are wrong alike. Here the nodes of the four quarters
of a rectangle foretell the integrand at its corners and in the middle of its sides: all nodes together, and alone those
of the quarter in whose corner the point lies. The former are right to what the rules differ by if the integrand is
smooth, the latter are if it has a kink elsewhere. If both are wrong, then by what the nodes do not see.
"""

import numpy as np

from .._jit import kernel

# Corners and middles of the sides, along each side of a rectangle: all points of the lattice but the centre.
LATTICE = np.array([0.0, 0.5, 1.0])
_BORDER = np.array([0, 1, 2, 3, 5, 6, 7, 8])
POINTS = len(_BORDER)
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
def foretell(values, weight, weights, quarter, start, told):
    """What each quarter foretells of the integrand, from the values at all nodes.

    Parameters
    ----------
    values : ndarray, shape (channels, m * n * n)
    weight : ndarray, shape (m * n * n,)
    weights : ndarray, shape (4, TOLD, n * n)
    quarter : ndarray of int, shape (parts,)
        0 to 3, or -1 of a part that is not a quarter.
    start : int
        Number of the first part.
    told : ndarray, shape (parts, channels, TOLD), out
    """
    nodes = weights.shape[2]
    f = np.empty(nodes)
    for k in range(weight.shape[0] // nodes):
        if quarter[start + k] < 0:
            continue
        table = weights[quarter[start + k]]
        for c in range(values.shape[0]):
            for i in range(nodes):
                f[i] = values[c, k * nodes + i] * weight[k * nodes + i]
            row = told[start + k, c]
            # Four at a time: one sum alone would wait for itself.
            for p in range(0, TOLD, 4):
                a = 0.0
                b = 0.0
                d = 0.0
                e = 0.0
                for i in range(nodes):
                    a += table[p, i] * f[i]
                    b += table[p + 1, i] * f[i]
                    d += table[p + 2, i] * f[i]
                    e += table[p + 3, i] * f[i]
                row[p] = a
                row[p + 1] = b
                row[p + 2] = d
                row[p + 3] = e


@kernel
def surprise(values, weight, told, first, start, out):
    """The least wrong of what was foretold, at the point of the border where that is most.

    Parameters
    ----------
    values : ndarray, shape (channels, m * 9)
        At the lattices of m rectangles.
    weight : ndarray, shape (m * 9,)
    told : ndarray, shape (parts, channels, TOLD)
    first : ndarray of int, shape (n,)
        The first quarters of all rectangles.
    start : int
        Number of the first rectangle.
    out : ndarray, shape (channels, n)
    """
    for k in range(weight.shape[0] // 9):
        at = first[start + k]
        for c in range(values.shape[0]):
            largest = 0.0
            for p in range(POINTS):
                here = 9 * k + _BORDER[p]
                f = values[c, here] * weight[here]
                joint = told[at, c, p] + told[at + 1, c, p] + told[at + 2, c, p] + told[at + 3, c, p]
                one = told[at + _QUARTERS[p, 0], c, POINTS + _CORNERS[p, 0]]
                other = told[at + _QUARTERS[p, 1], c, POINTS + _CORNERS[p, 1]]
                largest = max(largest, min(abs(f - joint), abs(f - one), abs(f - other)))
            out[c, start + k] = largest
