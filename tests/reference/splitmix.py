"""The random numbers once more, for whole arrays and backwards: keys whose draws are known beforehand."""

import numpy as np

GOLDEN = 0x9E3779B97F4A7C15
_M1, _M2 = 0xBF58476D1CE4E5B9, 0x94D049BB133111EB
_ALL = (1 << 64) - 1

# Draws of 64 bits that give the ends of [0, 1): exactly 0, and 1 - 2^-52.
SMALLEST, LARGEST = 0, _ALL


def _inverse(odd):
    """The inverse of an odd number modulo 2^64."""
    return pow(odd, -1, 1 << 64)


def _unshift(x, by):
    """Undo ``x ^ (x >> by)``."""
    found = x
    for _ in range(64 // by):
        found = x ^ (found >> by)
    return found


def mix(x):
    """The finaliser of splitmix64, of an integer or an array of uint64."""
    x = (x ^ (x >> 30)) * _M1 & _ALL
    x = (x ^ (x >> 27)) * _M2 & _ALL
    return x ^ (x >> 31)


def unmix(x):
    """The integer whose `mix` is ``x``."""
    x = _unshift(x, 31) * _inverse(_M2) & _ALL
    x = _unshift(x, 27) * _inverse(_M1) & _ALL
    return _unshift(x, 30)


def child(key, number):
    """The ``number``-th child of a key, an integer."""
    return mix(mix(key) + (number + 1) * GOLDEN & _ALL)


def parent(key, number):
    """The integer whose ``number``-th child is ``key``."""
    return unmix(unmix(key) - (number + 1) * GOLDEN & _ALL)


def key_that_draws(bits, counter):
    """The integer key whose draw number ``counter`` has these 64 bits."""
    return unmix(bits) - counter * GOLDEN & _ALL


def ancestor(key, *numbers):
    """The key from which ``numbers``, first to last, lead down to ``key``."""
    for number in reversed(numbers):
        key = parent(key, number)
    return key


def places(keys):
    """Where keys stand on the one long cycle that all draws come from: ndarray of uint64.

    The draws of a key begin at its place and go on from there one by one.
    """
    return np.asarray(keys, np.uint64) * np.uint64(_inverse(GOLDEN))
