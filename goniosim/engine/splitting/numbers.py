"""The random numbers of a batch: two for each facet, and those of many facets from two.

A ray that meets several facets of one interface spreads them by a lattice of its own, or takes consecutive points of
the lattice that all paths share. Some of all facets are drawn from the tail of their distribution: rare facets carry
the dim parts of a slice, and replicates that miss them would state an error that is too small.
"""

from ..._jit import kernel, scalar, stage
from ...optics.elementary import sincos_turns
from ...optics.random import derive_key, uniform
from ..lattice import STEPS, coordinate

# Steps of the two-dimensional lattice, for facets of one ray: powers of the root of g^3 = g + 1.
_STEP_U = 0.7548776662466927
_STEP_V = 0.5698402909980532

# The tail: share of a distribution, and share of the facets that are drawn from it.
_TAIL = 0.01
_DRAWN = 0.03
_LEAST = 1e-4
# Product of the ratios of a ray, from which on its facets are not drawn so: light that is caught meets hundreds, and
# the few rays that met none of the tail would carry all of it.
MOST = 2.0


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


@scalar
def steps_of(dimension):
    """Steps from one facet of a ray to the next."""
    return STEPS[dimension] if dimension >= 0 else _STEP_U, STEPS[dimension + 1] if dimension >= 0 else _STEP_V


@stage
def facet_numbers(u, v, n, number, dimension, before, cosines, sines, heights, ratios):
    """What the ``number``-th facet of each ray takes: cosine and sine of a uniform azimuth, and `far_facet`.

    ``before`` are the products of the ratios of the facets that the rays have met.
    """
    step_u, step_v = steps_of(dimension)
    for i in range(n):
        sines[i], cosines[i] = sincos_turns(coordinate(u[i], number, step_u))
        height = coordinate(v[i], number, step_v)
        far, ratio = far_facet(height)
        heights[i] = far if before[i] < MOST else height
        ratios[i] = ratio if before[i] < MOST else 1.0


@scalar
def far_facet(u):
    """A number for the height of a facet, of a density that favours 1, where tails begin; and one over that density.

    The share of facets beyond a slope s falls with s^(-2/3) instead of s^-2. Such ratios are kept apart from a ray's
    weights: roulette, if it saw the product, would end the very rays that were drawn for the tails.
    """
    # Nowhere so small that the facet would be no facet.
    t = max((1.0 - u) * (1.0 / _DRAWN), _LEAST)
    far = t < 1.0
    height = 1.0 - _TAIL * (t * t * t) if far else u * ((1.0 - _TAIL) / (1.0 - _DRAWN))
    return height, (3.0 * _TAIL / _DRAWN) * (t * t) if far else (1.0 - _TAIL) / (1.0 - _DRAWN)


@kernel
def lattice_shifts(key, shifts):
    """Fill ``shifts`` with independent uniform numbers."""
    for i in range(shifts.shape[0]):
        shifts[i] = uniform(key, i)
