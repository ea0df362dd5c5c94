"""Rays of the walk to an interface: how they start, wait in queues, and branch."""

import numpy as np

from ..._jit import stage
from ...optics.random import derive_key, uniform
from ..sorting import move, sort
from .rays import GAIN, KEY, LEAST_COSINE, MOVED, NEXT_KEY, NEXT_X, NEXT_Y, NEXT_Z, RATIO, SLOT, WEIGHT, X, Y, Z

# A ray that would be fainter than this, had its facets been drawn from plain distributions, plays Russian roulette.
FAINT, NEVER = 0.01, 1e-290
# Numbers that a ray draws at an event besides those of `facets`: roulettes of the two branches, a coin; and the keys of
# the branches.
_ROULETTE, _COIN, _BRANCH = 3, 5, 6


@stage
def launch(batch, n, light, number, slot, numbers):
    """A batch of new paths, with their numbers."""
    for field in range(SLOT + 1):
        value = light[field] if field <= Z else (1.0 if field == RATIO else slot)
        row = batch[field]
        for i in range(n):
            row[i] = value
    batch[Z, :n] = max(light[2], LEAST_COSINE)
    for i in range(n):
        numbers[i] = number + i


@stage
def close_up(batch, n, channels, scratch, steps, lists):
    """Keep the rays that have entered, with the numbers of their paths for keys; returns how many those are."""
    gain = scratch[GAIN]
    _, m = sort(gain, gain, n, steps, lists[0], lists[1])
    move(scratch[NEXT_X], n, lists[1], m, batch[X], 0)
    move(scratch[NEXT_Y], n, lists[1], m, batch[Y], 0)
    move(scratch[NEXT_Z], n, lists[1], m, batch[Z], 0)
    move(scratch[NEXT_KEY], n, lists[1], m, batch[KEY], 0)
    ratio = batch[RATIO]
    moved = scratch[MOVED]
    move(ratio, n, lists[1], m, moved, 0)
    for i in range(m):
        ratio[i] = moved[i]
    for c in range(channels):
        move(gain, n, lists[1], m, batch[WEIGHT + c], 0)
    return m


@stage
def pop(queue, start, batch, n):
    """Take ``n`` rays from ``start`` on."""
    for field in range(queue.shape[0]):
        source = queue[field][start : start + n]
        row = batch[field]
        for i in range(n):
            row[i] = source[i]


@stage
def derive_keys(numbers, n, paths_key):
    """Put keys in the place of numbers of paths."""
    keys = numbers.view(np.uint64)
    for i in range(n):
        keys[i] = derive_key(paths_key, np.uint64(numbers[i]))


@stage
def toss(row, n, reflectance):
    """Follow one branch, chosen by the weights of both."""
    keys = row.view(np.uint64)
    for i in range(n):
        reflectance[i] = 1.0 if uniform(keys[i], _COIN) < reflectance[i] else 0.0


@stage
def play(row, n, through, faint, brightest, gain, next_row):
    """Roulette on a branch, of rays below ``faint``, and the keys of its rays."""
    keys = row.view(np.uint64)
    next_keys = next_row.view(np.uint64)
    inverse = 1.0 / faint
    for i in range(n):
        bright = brightest[i] * inverse
        wins = uniform(keys[i], _ROULETTE + through) < gain[i] * bright
        # Who is not faint wins, and keeps the weight.
        gain[i] = max(gain[i], 1.0 / max(bright, 1e-300)) if wins else 0.0
    for i in range(n):
        next_keys[i] = derive_key(keys[i], _BRANCH + through)


@stage
def push(batch, n, channels, scratch, steps, lists, queue, start, first):
    """Append a branch to a queue; returns how many rays that are. Fields before ``first`` do not matter there."""
    gain, moved, places = scratch[GAIN], scratch[MOVED], lists[1]
    _, m = sort(gain, gain, n, steps, lists[0], places)
    if first == X:
        move(scratch[NEXT_X], n, places, m, queue[X], start)
        move(scratch[NEXT_Y], n, places, m, queue[Y], start)
    move(scratch[NEXT_Z], n, places, m, queue[Z], start)
    move(batch[RATIO], n, places, m, queue[RATIO], start)
    move(scratch[NEXT_KEY], n, places, m, queue[KEY], start)
    move(batch[SLOT], n, places, m, queue[SLOT], start)
    for c in range(channels):
        weight = batch[WEIGHT + c]
        for i in range(n):
            moved[i] = weight[i] * gain[i]
        move(moved, n, places, m, queue[WEIGHT + c], start)
    return m
