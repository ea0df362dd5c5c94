"""Gauss-Legendre rules on rectangles of a slice."""

import numpy as np

from .._jit import kernel
from .border import TOLD, foretell, weights_of
from .pool import BLOCK
from .rectangle import fill


class Rule:
    """A product rule of n x n nodes on the unit square.

    Parameters
    ----------
    n : int

    Attributes
    ----------
    nodes, weights : ndarray, shape (n,)
    bend : ndarray, shape (n,)
        Functional of the values at the nodes that is zero for all polynomials of degree n - 2, and at
        most the largest value: how much a function bends along one side.
    border : ndarray, shape (4, TOLD, n * n)
        Of `border.weights_of`.
    unseen : float
        Share of a rectangle between its edge and the nearest nodes of its quarters.
    """

    def __init__(self, n):
        x, w = np.polynomial.legendre.leggauss(n)
        self.nodes = 0.5 * (1.0 + x)
        self.weights = 0.5 * w
        # The divided difference of the highest order.
        difference = np.array([1.0 / np.prod(x[i] - np.delete(x, i)) for i in range(n)])
        self.bend = difference / np.abs(difference).sum()
        self.border = weights_of(self.nodes)
        self.unseen = 0.5 * float(self.nodes[0])


def evaluate(density, grid, rule, rectangles, pool, quarter=None):
    """Apply a rule to rectangles of a slice.

    Parameters
    ----------
    density : Density
    grid : Grid
    rule : Rule
    rectangles : ndarray, shape (n, 4)
    pool : Pool
    quarter : ndarray of int, shape (n,), optional
        Which quarters of the rectangles before these are, or -1; by default, none is.

    Returns
    -------
    energy : ndarray, shape (channels, n)
    bends : ndarray, shape (2, n)
        How much the integrand bends along u and along psi, relative to its mean, in the channel where it
        bends most.
    told : ndarray, shape (n, channels, TOLD), or None
        Of `border.foretell`, where there are quarters.
    """
    per_rectangle = len(rule.nodes) ** 2
    energy = np.empty((density.channels, len(rectangles)))
    bends = np.empty((2, len(rectangles)))
    told = None if quarter is None else np.empty((len(rectangles), density.channels, TOLD))
    step = max(1, BLOCK // per_rectangle)
    light = grid.light

    def work(start):
        part = rectangles[start : start + step]
        x, y, z, weight = np.empty((4, len(part) * per_rectangle))
        values = np.empty((len(energy), len(x)))
        fill(grid.code, light, part, rule.nodes, x, y, z, weight)
        density.kernel(density.tables, density.light, x, y, z, values)
        add_up(values, weight, rule.weights, rule.bend, start, energy, bends)
        if quarter is not None:
            foretell(values, weight, rectangles, rule.nodes, rule.border, quarter, start, told)

    pool.in_blocks(work, len(rectangles), step)
    return energy, bends, told


@kernel
def add_up(values, weight, weights, bend, start, energy, bends):
    """Integrals and bends of the rectangles from number ``start`` on, from the values at all nodes."""
    n = weights.shape[0]
    count = weight.shape[0] // (n * n)
    for k in range(start, start + count):
        bends[0, k] = 0.0
        bends[1, k] = 0.0
    down = np.empty(n)
    for c in range(values.shape[0]):
        for k in range(count):
            total = 0.0
            along_u = 0.0
            along_psi = 0.0
            for j in range(n):
                down[j] = 0.0
            for i in range(n):
                row = 0.0
                across = 0.0
                for j in range(n):
                    at = (k * n + i) * n + j
                    f = values[c, at] * weight[at]
                    row += weights[j] * f
                    across += bend[j] * f
                    down[j] += bend[i] * f
                total += weights[i] * row
                along_psi += weights[i] * abs(across)
            for j in range(n):
                along_u += weights[j] * abs(down[j])
            energy[c, start + k] = total
            if total > 0.0:
                bends[0, start + k] = max(bends[0, start + k], along_u / total)
                bends[1, start + k] = max(bends[1, start + k], along_psi / total)
