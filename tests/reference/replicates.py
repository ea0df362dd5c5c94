"""Replicates of an estimator, and what the analog engine says of the same cells."""

import threading

import numpy as np

from goniosim.engine import simulate
from goniosim.engine.estimate import COMPONENT_OF
from goniosim.engine.layout import DOWN, UP
from goniosim.engine.plan import make_plan
from goniosim.engine.unit import child_key


def keys(seed, count):
    return np.array([child_key(child_key(seed, 12345), number) for number in range(count)], np.uint64)


def sides_of(plan):
    return tuple(side for side in (UP, DOWN) if plan.slots[side, 1] > 0)


def prepared(estimator, scene, sides=None):
    """The plan of a scene and an estimator that is ready to run, by default of all ways out."""
    plan = make_plan(scene)
    made = estimator(plan, sides_of(plan) if sides is None else sides)
    made.prepare()
    return plan, made


def make_replicates(plan, made, size, seed, count=32, direction=0):
    """Energies of the estimator's slots, shape (count, slots, D, rows, width)."""
    slots = sum(int(made.slots[side, 1]) for side in (UP, DOWN))
    out = np.full((count, slots, plan.n_distinct, plan.rows, plan.width), np.nan)
    workspace = made.workspace()
    for key, slices in zip(keys(seed, count), out, strict=True):
        workspace.run(direction, size, [key], slices[None], threading.Event())
    return out


def totals(plan, replicates):
    """Energies of whole slices, shape (count, slots)."""
    return replicates.sum(axis=(2, 3, 4)) * (plan.columns / plan.width)


def folded(plan, slices):
    """Analog slices (..., columns) on the columns that tell all: where two of them are one, their mean."""
    if plan.width == plan.columns:
        return slices
    return (0.5 * (slices + slices[..., ::-1]))[..., : plan.width]


def blocks(slices, rows, columns):
    """Sums over blocks of cells."""
    *shape, r, k = slices.shape
    return slices.reshape(*shape, r // rows, rows, k // columns, columns).sum(axis=(-3, -1))


def analog_blocks(scene, plan, side, rows, columns, runs=1, seed=1000):
    """Block sums of the folded slices by pooled analog runs, and their variances; shape (D, ...)."""
    name = COMPONENT_OF[side]
    mean = variance = 0.0
    for run in range(runs):
        found = simulate(scene, seed=seed + run, estimator="analog").components[name]
        mean = mean + blocks(folded(plan, found.energy[0][plan.distinct]), rows, columns) / runs
        # Both of a pair are hit by different paths.
        squares = folded(plan, found.stderr[0][plan.distinct] ** 2) * (plan.width / plan.columns)
        variance = variance + blocks(squares, rows, columns) / runs**2
    return mean, variance
