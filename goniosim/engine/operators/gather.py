"""Cells from a smooth radiance at the nodes: some points of each cell, if need be through a narrow exit.

In lockstep over some neighbouring cells of a row, in short loops that become vector code.
"""

import numpy as np

from ..._jit import kernel, stage
from ...optics.medium import path_length, transmittance
from ...optics.random import derive_key, uniform
from .exits import TAILS, core_heights, follow, tail_heights
from .light import LIGHTS, draw_light, see_light, weigh_light
from .points import columns_above, find_points
from .stencils import LANES, WEIGHTS, find_stencils, interpolate

# Points of a cell without an exit, and with one: the lobes of its facets are sampled along with the cell.
POINTS, POINTS_OF_EXIT = 2, 4
# Which child of a replicate's key draws points and facets.
CELLS = 2
# Cells at a time: their arrays stay in the nearest cache.
BLOCK = 128

# Rows of the scratch array. First what is drawn: a point, a facet, one of the tail, and one that the light meets.
U, V, AZIMUTH, HEIGHT, TAIL_AZIMUTH, TAIL_DRAW, LIGHT_AZIMUTH, LIGHT_HEIGHT = range(8)
_DRAWS_OF_POINTS, _DRAWS, _DRAWS_OF_LIGHT = 2, 6, 8
# The point, cos(theta_v) d omega_v there; the direction inside; the tail's facet, its share; what a look is worth.
X, Y, Z, MEASURE, INSIDE_X, INSIDE_Y, INSIDE_Z, TAIL_HEIGHT, TAIL_SHARE, GAIN, N_SCRATCH = range(8, 19)


@kernel
def gather(values, parametrization, rows, columns, parts, strip, light, exits, source, taus, key, out):
    """Add the energy that leaves into the cells of a folded slice, or into a strip of each.

    Parameters
    ----------
    values : ndarray, shape (azimuths, polar angles, stencils.padded(n))
        Radiance at the nodes: outside, or below an exit.
    parametrization, rows, columns : int
    parts : (int, int)
        Into how many parts cells are cut along the column and along the row; each has points of its own.
    strip : int
        Which of those along the column.
    light : ndarray, shape (3,)
    exits : ndarray, shape (0,) or (2,)
        Width of the exit and its index inside over outside, or nothing.
    source : ndarray, shape (0,) or (2,)
        The same of a top interface that the light itself comes through, for the first ``len(taus)`` of the n.
    taus : ndarray, shape (channels,)
        Optical depths before the exit.
    key : uint64
        Of the replicate.
    out : ndarray, shape (n, rows * width)
        Added to.
    """
    space = np.empty((N_SCRATCH, BLOCK))
    weights = np.empty((WEIGHTS, BLOCK))
    nodes = np.empty((4, BLOCK), np.int64)
    found = np.empty((values.shape[2] // LANES, BLOCK, LANES))
    shares = np.empty((taus.shape[0], BLOCK))
    places = np.empty(BLOCK, np.int64)
    width = out.shape[1] // rows
    cells_key = derive_key(key, CELLS)
    leaves = exits.shape[0] > 0
    # A smooth exit has one facet.
    rough = leaves and exits[0] > 0.0
    lit = source.shape[0] > 0
    draws = (_DRAWS_OF_LIGHT if lit else _DRAWS) if leaves else _DRAWS_OF_POINTS
    points = POINTS_OF_EXIT if leaves else POINTS
    high, wide = parts
    for row in range(rows):
        # Of cells as small as the parts.
        fine = row * high + strip
        count = columns_above(parametrization, fine, rows * high, columns * wide, width * wide, light)
        for first in range(0, count, BLOCK):
            n = min(BLOCK, count - first)
            _draw(cells_key, (strip * rows + row) * width * wide + first, n, draws, space)
            for i in range(n):
                places[i] = row * width + (first + i) // wide
            for i in range(points):
                find_points(
                    i * (4 // points), parametrization, fine, first, n, rows * high, columns * wide, light,
                    space[U], space[V], space[X], space[Y], space[Z], space[MEASURE],
                )  # fmt: skip
                tailed = rough and i % (POINTS_OF_EXIT // TAILS) == 0
                if tailed:
                    number = i // (POINTS_OF_EXIT // TAILS)
                    tail_heights(space[TAIL_DRAW], number, n, space[TAIL_HEIGHT], space[TAIL_SHARE])
                for tail in range(2 if tailed else 1):
                    _weigh(n, points, tailed, tail > 0, space[MEASURE], space[TAIL_SHARE], space[GAIN])
                    x, y, z = space[X], space[Y], space[Z]
                    if leaves:
                        _leave(n, i / points, tail > 0, exits, space)
                        x, y, z = space[INSIDE_X], space[INSIDE_Y], space[INSIDE_Z]
                    find_stencils(x, y, z, n, values, weights, nodes)
                    interpolate(values, weights, nodes, n, found)
                    if lit:
                        see_light(
                            x, y, z, space[X], space[Y], space[Z], n, light, source, exits, weights[0]
                        )  # fmt: skip
                        _add_light(weights[0], n, taus.shape[0], found)
                    _absorb(z, n, taus, leaves, space[GAIN], shares)
                    _add(found, n, shares, places, wide, out)
                if lit and rough and i % (POINTS_OF_EXIT // LIGHTS) == 0:
                    number = i // (POINTS_OF_EXIT // LIGHTS)
                    x, y, z = space[INSIDE_X], space[INSIDE_Y], space[INSIDE_Z]
                    draw_light(space[LIGHT_AZIMUTH], space[LIGHT_HEIGHT], number, n, light, source, x, y, z)
                    weigh_light(
                        x, y, z, space[X], space[Y], space[Z], n, light, source, exits, space[MEASURE], space[GAIN]
                    )  # fmt: skip
                    _absorb(z, n, taus, leaves, space[GAIN], shares)
                    _add_shares(shares, n, places, out)


@stage
def _draw(key, cell, n, dimensions, space):
    for dimension in range(dimensions):
        dimension_key = derive_key(key, dimension)
        row = space[dimension]
        for i in range(n):
            row[i] = uniform(dimension_key, cell + i)
    if dimensions >= _DRAWS:
        core_heights(n, space[HEIGHT])


@stage
def _weigh(n, points, tailed, tail, measure, shares, gain):
    """What a look is worth. That of the tail is taken from the core at the same point."""
    core = 0.0 if tail else 1.0 / points
    sign = 1.0 if tail else -1.0
    if tailed:
        for i in range(n):
            gain[i] = measure[i] * (core + sign * shares[i])
    else:
        for i in range(n):
            gain[i] = measure[i] * core


@stage
def _leave(n, turn, tail, exits, space):
    azimuths = space[TAIL_AZIMUTH if tail else AZIMUTH]
    heights = space[TAIL_HEIGHT if tail else HEIGHT]
    follow(
        space[X], space[Y], space[Z], azimuths, turn, heights, n, exits[0], exits[1],
        space[INSIDE_X], space[INSIDE_Y], space[INSIDE_Z], space[GAIN],
    )  # fmt: skip


@stage
def _add_light(seen, n, channels, found):
    """The light is in the first numbers."""
    for c in range(channels):
        lanes = found[c // LANES]
        for i in range(n):
            lanes[i, c % LANES] += seen[i]


@stage
def _absorb(z, n, taus, leaves, gain, shares):
    """What looks are worth after the way to the exit."""
    for c in range(taus.shape[0]):
        share = shares[c]
        tau = taus[c]
        if leaves and tau > 0.0:
            for i in range(n):
                share[i] = gain[i] * transmittance(tau, path_length(z[i]))
        else:
            for i in range(n):
                share[i] = gain[i]


@stage
def _add(found, n, shares, places, wide, out):
    for e in range(out.shape[0]):
        lanes = found[e // LANES]
        share = shares[e % shares.shape[0]]
        cells = out[e]
        if wide == 1:
            # Neighbours, in lockstep.
            cells = cells[places[0] : places[0] + n]
            for i in range(n):
                cells[i] += share[i] * lanes[i, e % LANES]
        else:
            for i in range(n):
                cells[places[i]] += share[i] * lanes[i, e % LANES]


@stage
def _add_shares(shares, n, places, out):
    for c in range(shares.shape[0]):
        share = shares[c]
        cells = out[c]
        for i in range(n):
            cells[places[i]] += share[i]
