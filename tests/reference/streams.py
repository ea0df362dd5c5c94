"""Random numbers in the orders in which walks use them, as long sequences."""

import numpy as np

from goniosim._jit import kernel
from goniosim.engine.lattice import DIMENSIONS
from goniosim.engine.operators.arrivals import PATHS, SHIFTS
from goniosim.engine.operators.gather import CELLS
from goniosim.engine.replicated import BRANCH
from goniosim.engine.rounds import REPLICATES
from goniosim.engine.stages.facets import FACET_AZIMUTH, FACET_HEIGHT
from goniosim.engine.stages.smooth_dielectric import COIN
from goniosim.engine.stages.travel import ROULETTE
from goniosim.engine.unit import BATCH, PARTS, UNITS
from goniosim.optics.random import derive_key, random_sincos, uniform

# Seeds far from each other, whose neighbours are used as well.
FAR_SEEDS = (0, 2**31, 2**32, 2**53, 2**62, 2**63 - 2**30)
# Draws of an operator's ray at an event, and children of its key; draws of a cell with an exit, and of one of a base.
_OPERATOR_DRAWS, _BRANCHES = 6, (6, 7)
_CELL_DRAWS, _BASE_DRAWS = 8, 4


@kernel
def _derive(keys, numbers, out):
    for i in range(keys.shape[0]):
        for j in range(numbers.shape[0]):
            out[i, j] = derive_key(keys[i], numbers[j])


@kernel
def _draw(keys, counters, out):
    for i in range(keys.shape[0]):
        for j in range(counters.shape[0]):
            out[i, j] = uniform(keys[i], counters[j])


@kernel
def _turn(keys, counters, sines, cosines):
    for i in range(keys.shape[0]):
        for j in range(counters.shape[0]):
            sines[i, j], cosines[i, j] = random_sincos(keys[i], counters[j])


def children(keys, *generations):
    """Keys of a family: of each key its children of some numbers, of these theirs, an axis for each generation."""
    keys = np.asarray(keys, np.uint64)
    for numbers in generations:
        out = np.empty((keys.size, len(numbers)), np.uint64)
        _derive(keys.ravel(), np.asarray(numbers, np.int64), out)
        keys = out.reshape(*keys.shape, -1)
    return keys


def numbers(keys, counters):
    """Uniform numbers of keys, with an axis more for ``counters`` (how many, or which)."""
    keys = np.asarray(keys, np.uint64)
    counters = np.arange(counters) if np.ndim(counters) == 0 else np.asarray(counters)
    out = np.empty((keys.size, len(counters)))
    _draw(keys.ravel(), counters, out)
    return out.reshape(*keys.shape, -1)


def turns(keys, counters):
    """Random azimuths as shares of a turn; arguments as of `numbers`."""
    keys = np.asarray(keys, np.uint64)
    counters = np.arange(counters) if np.ndim(counters) == 0 else np.asarray(counters)
    sines, cosines = np.empty((2, keys.size, len(counters)))
    _turn(keys.ravel(), counters, sines, cosines)
    return (np.arctan2(sines, cosines) / (2.0 * np.pi) % 1.0).reshape(*keys.shape, -1)


def analog_keys(seeds=(1,), directions=(0,), units=(0,), parts=(0,), stages=(0,), decisions=(COIN,)):
    """Keys of the analog walk, of shape (seeds, directions, units, parts, stages, decisions)."""
    found = children(seeds, [UNITS], directions, units, parts, stages, decisions)
    return found[:, 0]


def replicate_keys(seeds=(1,), directions=(0,), rounds=(0,), replicates=(0,)):
    """Keys of replicates, of shape (seeds, directions, rounds, replicates)."""
    return children(seeds, [BRANCH], directions, rounds, replicates)[:, 0]


def _stages(n, decisions=(COIN,)):
    """One part of a unit: numbers of shape (stages, rays, decisions)."""
    keys = analog_keys(stages=range(-(-n // BATCH)), decisions=decisions)[0, 0, 0, 0]
    return np.moveaxis(numbers(keys, BATCH), 1, 2)


def _decisions(n):
    return _stages(-(-n // 4), (FACET_AZIMUTH, FACET_HEIGHT, COIN, ROULETTE))


def _parts(n):
    keys = analog_keys(units=range(-(-n // (8 * PARTS))), parts=range(PARTS))
    return np.moveaxis(numbers(keys[0, 0, :, :, 0, 0], 8), 2, 1)


def _units(n):
    return numbers(analog_keys(units=range(-(-n // 64)))[0, 0, :, 0, 0, 0], 64).T


def _directions(n):
    return numbers(analog_keys(directions=range(-(-n // 64)))[0, :, 0, 0, 0, 0], 64).T


def _seeds(n):
    return numbers(analog_keys(seeds=range(-(-n // 64)))[:, 0, 0, 0, 0, 0], 64).T


def _far_seeds(n):
    count = -(-n // (16 * len(FAR_SEEDS)))
    seeds = [far + i for i in range(count) for far in FAR_SEEDS]
    return numbers(analog_keys(seeds=seeds)[:, 0, 0, 0, 0, 0], 16).T


def _shifts(n):
    rounds = -(-n // (DIMENSIONS * REPLICATES))
    keys = replicate_keys(rounds=range(rounds), replicates=range(REPLICATES))
    return numbers(children(keys, [SHIFTS])[0, 0, ..., 0], DIMENSIONS)


def _paths(n):
    paths = children(replicate_keys(), [PATHS], range(-(-n // _OPERATOR_DRAWS)))
    return numbers(paths.ravel(), _OPERATOR_DRAWS)


def _branches(n):
    depth = 16
    keys = [children(replicate_keys(), [PATHS], range(-(-n // (_OPERATOR_DRAWS * depth)))).ravel()]
    for generation in range(1, depth):
        keys.append(children(keys[-1], [_BRANCHES[generation % 2]]).ravel())
    return numbers(np.stack(keys, axis=1), _OPERATOR_DRAWS)


def _points(n):
    keys = children(replicate_keys(), [CELLS], range(_CELL_DRAWS)).ravel()
    return numbers(keys, -(-n // _CELL_DRAWS)).T


def _bases(n):
    return numbers(children(replicate_keys(), [1], range(-(-n // _BASE_DRAWS))).ravel(), _BASE_DRAWS)


_ORDERS = {
    "rays, then stages": _stages,
    "stages, then rays": lambda n: _stages(n).T,
    "decisions of rays": _decisions,
    "parts of units": _parts,
    "units": _units,
    "directions": _directions,
    "neighbouring seeds": _seeds,
    "far seeds and their neighbours": _far_seeds,
    "dimensions of shifts": _shifts,
    "shifts of one dimension": lambda n: np.moveaxis(_shifts(n), -1, 0),
    "draws of paths": _paths,
    "paths, then draws": lambda n: _paths(n).T,
    "branches of paths": _branches,
    "dimensions of cells": _points,
    "cells of a base": _bases,
}
STREAMS = tuple(_ORDERS)


def stream(name, n):
    """The first ``n`` numbers in an order of `STREAMS`."""
    return np.ascontiguousarray(_ORDERS[name](n)).ravel()[:n]
