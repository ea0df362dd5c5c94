"""The random numbers of a batch: two for each facet, and those of many facets from two.

A ray that meets several facets of one interface spreads them by a lattice of its own, or takes consecutive points of
the lattice that all paths share.
"""

from ..._jit import kernel, stage
from ...optics.elementary import sincos_turns
from ...optics.random import derive_key, uniform
from ..lattice import STEPS, coordinate

# Steps of the two-dimensional lattice, for facets of one ray: powers of the root of g^3 = g + 1.
_STEP_U = 0.7548776662466927
_STEP_V = 0.5698402909980532


@stage
def lattice_points(path, n, facets, dimension, shifts, u, v):
    """Points of the lattice of all paths, ``facets`` places for each of ``n`` rays."""
    shift_u = shifts[dimension]
    shift_v = shifts[dimension + 1]
    step_u = STEPS[dimension]
    step_v = STEPS[dimension + 1]
    for i in range(n):
        u[i] = coordinate(shift_u, path[i] * facets, step_u)
        v[i] = coordinate(shift_v, path[i] * facets, step_v)


@stage
def hashed_points(n, key, u, v):
    """Independent points."""
    u_key = derive_key(key, 0)
    v_key = derive_key(key, 1)
    for i in range(n):
        u[i] = uniform(u_key, i)
        v[i] = uniform(v_key, i)


@stage
def facet_numbers(u, v, n, number, dimension, cosines, sines, heights):
    """What the ``number``-th facet of each ray takes: cosine and sine of a uniform azimuth, and a height."""
    step_u = STEPS[dimension] if dimension >= 0 else _STEP_U
    step_v = STEPS[dimension + 1] if dimension >= 0 else _STEP_V
    for i in range(n):
        sines[i], cosines[i] = sincos_turns(coordinate(u[i], number, step_u))
        heights[i] = coordinate(v[i], number, step_v)


@kernel
def lattice_shifts(key, shifts):
    """Fill ``shifts`` with independent uniform numbers."""
    for i in range(shifts.shape[0]):
        shifts[i] = uniform(key, i)
