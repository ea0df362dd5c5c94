"""How likely independent uniform numbers are to look as strange as some sequence does, by several tests.

Each returns a p-value, multiplied by the number of its comparisons. Moments, sums and counts are of hundreds of
thousands of numbers, so that normal and chi-square laws hold far out.
"""

import numpy as np
from scipy import special, stats

# Numbers in a box of a chi-square test, at the least.
_PER_BOX = 64
# Lags of serial correlations: short ones, and powers of two.
_SHORT_LAGS = 200
BITS = 52


def chances(u):
    """P-values of a sequence by the name of the test; a power of two of numbers in [0, 1)."""
    return {
        **{f"boxes in {d} dimensions": boxes(u[: len(u) // d * d].reshape(-1, d)) for d in (1, 2, 3)},
        "serial correlation": serial(u),
        "period": period(u),
        "spectrum": spectrum(u),
        "bits": bits(u),
    }


def smallest(found):
    """The smallest of some p-values, times their number."""
    return min(found.values()) * len(found)


def chi_square(counts):
    """Of counts that should be equal, too different or too equal."""
    expected = counts.sum() / counts.size
    statistic = ((counts - expected) ** 2).sum() / expected
    return _both_sides(stats.chi2(counts.size - 1), statistic)


def _both_sides(law, value):
    return 2.0 * min(law.sf(value), law.cdf(value))


def _normal(z):
    """Of the largest of some standard normal deviates."""
    return np.size(z) * special.erfc(np.abs(z).max() / np.sqrt(2.0))


def boxes(points):
    """Chi-square over equal boxes of the unit cube, for points of shape (n, dimensions)."""
    n, dimensions = points.shape
    side = 1 << int(np.log2(n / _PER_BOX) / dimensions)
    places = np.zeros(n, np.int64)
    for column in points.T:
        places = places * side + np.minimum((column * side).astype(np.int64), side - 1)
    return chi_square(np.bincount(places, minlength=side**dimensions))


def serial(u):
    """Correlation with itself, at lags from 1 to 200 and all powers of two up to half the length."""
    n = len(u)
    lags = np.unique([*range(1, _SHORT_LAGS + 1), *(1 << k for k in range(int(np.log2(n))))])
    x = np.zeros(2 * n)
    x[:n] = np.sqrt(12.0) * (u - 0.5)
    power = np.abs(np.fft.rfft(x)) ** 2
    return _normal(np.fft.irfft(power)[lags] / np.sqrt(n - lags))


def _periodogram(u):
    """Power at all frequencies but the first and the last: exponential numbers of mean 1."""
    return (np.abs(np.fft.rfft(u - 0.5)) ** 2)[1:-1] * (12.0 / len(u))


def period(u):
    """The strongest frequency."""
    power = _periodogram(u)
    return len(power) * np.exp(-power.max())


def spectrum(u):
    """Kolmogorov's test of the powers against the exponential law, and of their sums along the frequencies."""
    power = _periodogram(u)
    m = len(power)
    law = -np.expm1(-np.sort(power))
    along = np.cumsum(power) / power.sum()
    steps = np.arange(1, m + 1) / m
    distance = max(np.abs(law - steps).max(), np.abs(along - steps).max())
    return 2.0 * special.kolmogorov(np.sqrt(m) * distance)


def bits(u):
    """Of each of the 52 bits: ones, changes from number to number, and agreement with all other bits."""
    n = len(u)
    whole = (u * 2.0**BITS).astype(np.int64)
    ones = np.zeros(BITS)
    changes = np.zeros(BITS)
    agreement = np.zeros((BITS, BITS))
    for start in range(0, n, 1 << 16):
        # One number more, for the change to the next part.
        part = whole[start : start + (1 << 16) + 1]
        signs = ((part >> np.arange(BITS)[:, None]) & 1).astype(np.float32) * 2 - 1
        changes += (signs[:, 1:] * signs[:, :-1]).sum(axis=1)
        signs = signs[:, : 1 << 16]
        ones += signs.sum(axis=1)
        agreement += signs @ signs.T
    pairs = agreement[np.triu_indices(BITS, 1)]
    return _normal(np.concatenate([ones, changes, pairs]) / np.sqrt(n))


def correlations(streams):
    """Of the numbers of any two streams, shape (streams, numbers): the largest, and the sum of all squares."""
    count, n = streams.shape
    x = np.sqrt(12.0) * (streams - 0.5)
    z = (x @ x.T)[np.triu_indices(count, 1)] / np.sqrt(n)
    return 2.0 * min(_normal(z), _both_sides(stats.chi2(z.size), (z**2).sum()))


def crowding(places):
    """How many places on the cycle of 2^64 are nearer to the next one than 2^k, for any k: Poisson numbers."""
    places = np.sort(places)
    gaps = np.diff(places, append=places[:1])
    n = len(gaps)
    found = []
    for k in range(64 - int(np.log2(n))):
        expected = n * -np.expm1(-n * 2.0 ** (k - 64))
        found.append(stats.poisson.sf((gaps < 1 << k).sum() - 1, expected))
    return len(found) * min(found)
