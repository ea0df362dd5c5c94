"""Cosine series in azimuth: products with one matrix of cosines, halved by the symmetry of its rows.

Convolution in azimuth multiplies coefficients. With N + 1 nodes from 0 to pi, the coefficients of folded arrivals H are
plain sums over the nodes, those of an even function K have the weights 1, 2, ..., 2, 1, and the convolution at the
azimuth phi is the sum over m of the products times cos(m phi) and the same weights, over 2 N.
"""

import numpy as np


def cosines(nodes):
    """cos(pi m j / N) of coefficients m and nodes j = 0 ... N; ndarray, shape (N + 1, N + 1)."""
    number = np.arange(nodes + 1)
    # Whole numbers of steps: no digit is lost for large products.
    return np.cos(np.pi / nodes * np.arange(2 * nodes))[np.multiply.outer(number, number) % (2 * nodes)]


def end_weights(nodes):
    """1, 2, ..., 2, 1: of the nodes of an even, periodic function, or of its coefficients."""
    weights = np.full(nodes + 1, 2.0)
    weights[[0, -1]] = 1.0
    return weights


def to_coefficients(matrix, values, found):
    """Multiply ``values`` by a matrix of cosines along the first axis, which is overwritten.

    Parameters
    ----------
    matrix : ndarray, shape (N + 1, N + 1)
        Columns may be weighted, alike for nodes j and N - j; N is even.
    values, found : ndarray, shape (N + 1, n)
    """
    half = len(values) // 2
    low, high = values[:half], values[: -half - 1 : -1]
    # Even coefficients see sums of nodes j and N - j, odd ones differences, and nothing of the one between.
    low -= high
    np.matmul(matrix[1::2, :half], low, out=found[1::2])
    low += high
    low += high
    np.matmul(matrix[::2, : half + 1], values[: half + 1], out=found[::2])


def at_azimuths(nodes, azimuths):
    """The matrix from products of coefficients to values at ``azimuths`` (in node distances), for `to_values`."""
    turns = np.multiply.outer(np.asarray(azimuths, float), np.arange(nodes + 1)) % (2 * nodes)
    return np.cos(np.pi / nodes * turns) * (end_weights(nodes) / (2 * nodes))


def to_values(matrix, coefficients, found):
    """Values at azimuths that are symmetric about pi/2: of the first half, and by the symmetry of cosines of the other.

    Parameters
    ----------
    matrix : ndarray, shape (P, N + 1)
    coefficients : ndarray, shape (N + 1, n)
    found : ndarray, shape (P, n)
    """
    some = (len(matrix) + 1) // 2
    even = matrix[:some, ::2] @ coefficients[::2]
    odd = matrix[:some, 1::2] @ coefficients[1::2]
    np.add(even, odd, out=found[:some])
    np.subtract(even, odd, out=found[: -some - 1 : -1])
