"""Counter-based random numbers: a hash of (key, counter), no state.

The finaliser of splitmix64 (Steele, Lea, Flood 2014) on an arithmetic sequence. A draw costs
two multiplications, vectorises, and depends on nothing but its key and its counter, so the
same seed gives the same bits for any number of threads and any order of work.
"""

import numpy as np

from .._jit import scalar
from .elementary import bits_to_float, float_to_bits, sincos_octants

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_M1 = np.uint64(0xBF58476D1CE4E5B9)
_M2 = np.uint64(0x94D049BB133111EB)
_S30 = np.uint64(30)
_S27 = np.uint64(27)
_S31 = np.uint64(31)
_S12 = np.uint64(12)
_ONE = np.uint64(0x3FF0000000000000)
_BIT = np.uint64(1)
_S1 = np.uint64(1)
_S63 = np.uint64(63)


@scalar
def mix(x):
    """Scramble 64 bits; a bijection."""
    x = (x ^ (x >> _S30)) * _M1
    x = (x ^ (x >> _S27)) * _M2
    return x ^ (x >> _S31)


@scalar
def derive_key(key, number):
    """An independent key for the ``number``-th child of ``key``."""
    return mix(mix(np.uint64(key)) + (np.uint64(number) + np.uint64(1)) * _GOLDEN)


@scalar
def uniform(key, counter):
    """The ``counter``-th random number of ``key``: uniform in [0, 1), a multiple of 2^-52."""
    return bits_to_float((mix(key + np.uint64(counter) * _GOLDEN) >> _S12) | _ONE) - 1.0


@scalar
def random_sincos(key, counter):
    """Sine and cosine of the ``counter``-th random azimuth of ``key``.

    52 bits are the angle within a quarter turn about an axis, two more the axis.
    """
    bits = mix(key + np.uint64(counter) * _GOLDEN)
    s, c = sincos_octants(bits_to_float((bits >> _S12) | _ONE) - 1.5)
    swap = (bits & _BIT) != 0
    opposite = ((bits >> _S1) & _BIT) << _S63
    sine = c if swap else s
    cosine = s if swap else c
    return bits_to_float(float_to_bits(sine) ^ opposite), bits_to_float(float_to_bits(cosine) ^ opposite)
