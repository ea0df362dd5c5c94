"""A shifted lattice: points that fill a cube more evenly than independent ones.

The additive recurrence of the generalised golden ratio: with g > 1 the root of g^(d + 1) = g + 1, coordinate j of
point i is the fraction of shift_j + i g^-(j + 1). Shifted uniformly, every single point is uniform, so that means are
unbiased; one shift per replicate and dimension, and only for events that a path meets once.
"""

import math

import numpy as np

from .._jit import stage

DIMENSIONS = 6


def _steps(dimensions):
    g = 2.0
    for _ in range(64):
        g = (1.0 + g) ** (1.0 / (dimensions + 1))
    return np.array([g ** -(j + 1.0) for j in range(dimensions)])


# Steps from one point to the next, for the number of dimensions that a path uses at most.
STEPS = _steps(DIMENSIONS)


@stage
def coordinate(shift, number, step):
    """Coordinate of the ``number``-th point of a lattice, in [0, 1)."""
    value = shift + number * step
    return value - math.floor(value)
