"""Width and direction of a lobe, each with the standard error that the noise of the slice gives it."""

import numpy as np

from .curves import curve
from .verdicts import Value

GREEN = 1
# Degrees over which a curve is averaged before its peak is looked for.
WINDOW = 10.0
# Repetitions with noise added, for standard errors.
DRAWS = 100


def width(slices, found, theta_deg, channel=GREEN):
    """Interquartile range of the energy over the sine of the angle in the plane of incidence.

    Parameters
    ----------
    slices : Slices
    found : Slice
    theta_deg : float
        Of the light.
    channel : int

    Returns
    -------
    Value
    """
    m = slices.direction(theta_deg)
    valid = slices.result.cells.valid[m]
    x = slices.along_plane(m)[valid]
    energy, stderr = (part[m, channel][valid] for part in (found.energy, found.stderr))
    return _with_noise(lambda values: interquartile_range(x, values), energy, stderr)


def interquartile_range(x, weights):
    """Distance between the first and the third quartile of ``x`` with weights, each of shape (n,)."""
    order = np.argsort(x)
    share = np.maximum.accumulate(np.cumsum(weights[order]))
    low, high = np.interp([0.25 * share[-1], 0.75 * share[-1]], share, x[order])
    return high - low


def peak(slices, found, theta_deg, channel=GREEN):
    """Signed angle in degrees at which the curve in the plane of incidence, averaged over `WINDOW`, is highest.

    Parameters
    ----------
    slices, found, theta_deg, channel
        As in `width`.

    Returns
    -------
    Value
    """
    angle, f, sigma = curve(slices, found, theta_deg)
    near = np.abs(angle[:, None] - angle) <= 0.5 * WINDOW
    weights = near * np.gradient(angle)
    weights /= weights.sum(axis=1, keepdims=True)
    return _with_noise(lambda values: angle[np.argmax(weights @ values)], f[:, channel], sigma[:, channel])


def _with_noise(statistic, values, stderr):
    """A statistic with its scatter when as much noise again is added."""
    rng = np.random.default_rng(1)
    scatter = (
        [statistic(values + stderr * rng.standard_normal(len(values))) for _ in range(DRAWS)] if stderr.any() else [0.0]
    )
    return Value(float(statistic(values)), float(np.std(scatter)))
