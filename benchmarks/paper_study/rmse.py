"""The error of Eq. 4 from slices, the noise of the simulation taken out; see docs/compare.md for the formulas."""

import numpy as np

from .verdicts import Value


def debiased(difference, sigma, size):
    """Root mean square error over directions, in each channel.

    Parameters
    ----------
    difference, sigma : ndarray, shape (M, C, R, K)
        Model minus simulation in 1/sr, and the standard error of the simulation.
    size : ndarray, shape (M, R, K)
        Weight of every cell in sr; 0 where it does not count.

    Returns
    -------
    list of Value
    """
    d2, s2, weight = difference**2, sigma**2, size[:, None]
    # The noise of the mirror-image cell is not correlated with this cell's difference.
    other = s2[..., ::-1]
    squared = _total(weight * (d2 - s2))
    variance = np.maximum(_total(4.0 * weight**2 * d2 * other) - _total(2.0 * weight**2 * s2 * other), 0.0)
    mean, error = squared.mean(axis=0), np.sqrt(variance.sum(axis=0)) / len(squared)
    return [_root(m, e) for m, e in zip(mean, error, strict=True)]


def mean_of(values):
    """Mean over channels, which share their paths: errors are taken to be fully correlated."""
    return Value(float(np.mean([v.value for v in values])), float(np.mean([v.stderr for v in values])))


def _root(square, stderr):
    root = np.sqrt(max(square, 0.0))
    if square > 2.0 * stderr:
        return Value(float(root), float(stderr / (2.0 * root)) if root > 0.0 else 0.0)
    return Value(float(root), float(np.sqrt(max(square, 0.0) + stderr) - root))


def _total(values):
    return values.sum(axis=(-2, -1))
