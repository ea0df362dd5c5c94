"""Rays that wait in queues, and batches that are taken from them."""

import numpy as np

from ..._jit import stage
from ..layout import WEIGHT, X, Y, Z
from .layout import PATH, RATIO


@stage
def launch(batch, n, light, channels, number):
    """A batch of new paths, the first of which has the given number."""
    for field in range(batch.shape[0]):
        # What follows the weights is the order, which begins at zero.
        value = light[field] if field < WEIGHT else (1.0 if field < WEIGHT + channels else 0.0)
        row = batch[field]
        for i in range(n):
            row[i] = value
    ratio = batch[RATIO]
    path = batch[PATH]
    for i in range(n):
        ratio[i] = 1.0
    for i in range(n):
        path[i] = number + i


@stage
def pop(queue, start, batch, n, first):
    """Take ``n`` rays from ``start`` on; fields before ``first`` do not matter."""
    for field in range(first, batch.shape[0]):
        source = queue[field][start : start + n]
        row = batch[field]
        for i in range(n):
            row[i] = source[i]


@stage
def close_up(batch, n, factor, places):
    """Keep the rays whose ``factor`` is above zero; returns how many those are."""
    m = list_alive(factor, n, places)
    if m < n:
        for field in range(batch.shape[0]):
            row = batch[field]
            for j in range(m):
                row[j] = row[places[j]]
    return m


@stage
def push(batch, n, x, y, z, gain, channels, places, queue, start, first):
    """Append the rays of new directions whose ``gain`` is above zero to a queue; returns how many those are.

    Weights are multiplied by the gain. Fields before ``first`` do not matter there.
    """
    m = list_alive(gain, n, places)
    if first <= X:
        _move(x, n, m, places, queue[X][start : start + m])
        _move(y, n, m, places, queue[Y][start : start + m])
    _move(z, n, m, places, queue[Z][start : start + m])
    for c in range(channels):
        _move_scaled(batch[WEIGHT + c], gain, n, m, places, queue[WEIGHT + c][start : start + m])
    for field in range(WEIGHT + channels, batch.shape[0]):
        _move(batch[field], n, m, places, queue[field][start : start + m])
    return m


@stage
def list_alive(factor, n, places):
    """List the places where ``factor`` is above zero; returns how many those are."""
    m = np.int64(0)
    for i in range(n):
        places[m] = i
        m += 1 if factor[i] > 0.0 else 0
    return m


@stage
def _move(source, n, m, places, row):
    if m == n:
        for i in range(n):
            row[i] = source[i]
    else:
        for i in range(m):
            row[i] = source[places[i]]


@stage
def _move_scaled(source, gain, n, m, places, row):
    if m == n:
        for i in range(n):
            row[i] = source[i] * gain[i]
    else:
        for i in range(m):
            row[i] = source[places[i]] * gain[places[i]]
