"""How accurate slices are, in one number, and what a target is held against.

Three readings: of the ``slice``, the Eq. 4 norm of the standard error over that of the slice; of the ``albedo``, the
relative error of the sum of all cells; of the ``cells``, the relative error that 95 % of those cells keep which
hold 95 % of the energy. Never more is asked of cells that may be empty. Channels of which nothing was seen do not
count beside others. Where there are no others the error is unknown, hence infinite: nothing seen is not nothing there.

A standard error is what the true error is on average, and a run that stops as soon as it is as asked for is off by more
every second or third time. So a target is held against what the true error of a slice or an albedo stays below in nine
of ten runs. Of ``cells`` it is the standard errors themselves: there are many of them in one run.
"""

import math

import numpy as np

READINGS = ("slice", "albedo", "cells")
# Share of the energy that the cells hold which are looked at one by one, and which of them decides.
BRIGHT = 0.95
PERCENTILE = 95.0
# Nine of ten normal numbers are smaller.
NINE_OF_TEN = 1.2816
# The squares of what is fainter underflow, so that it has no scatter that tells an error.
FAINTEST = 1e-150
# The s of a noise that falls as N^-s: of independent paths; and of a lattice, as far as one may hope.
INDEPENDENT, FASTEST = 0.5, 1.0
# Decimal places of a number of light paths, as many as are told.
_MOST_PLACES = 250.0


def relative_error(of, energy, stderr, total, projected_solid_angle, weights):
    """Relative standard error of a component in one incident direction.

    Parameters
    ----------
    of : str
        One of `READINGS`.
    energy, stderr : ndarray, shape (channels, rows, columns)
        Fractions of the incident flux.
    total : (ndarray, ndarray)
        Energy of all cells and its standard error, each of shape (channels,).
    projected_solid_angle : ndarray, shape (rows, columns)
        In sr; 0 for cells that are not valid.
    weights : ndarray, shape (channels,)
        How much each channel counts.

    Returns
    -------
    float
        Infinite where it is unknown: nothing was seen, or less than `FAINTEST`.
    """
    if of == "albedo":
        value, error = total
        return _mean(_over(error, value), value, weights)
    if of == "cells":
        return _mean(np.array(list(map(_of_cells, energy, stderr))), energy.sum(axis=(1, 2)), weights)
    value, error = (norm(each, projected_solid_angle) for each in (energy, stderr))
    return _mean(_over(error, value), value, weights)


def bound(of, energy, stderr, total, projected_solid_angle, weights, noise, bias=None):
    """What a target is held against.

    Like `relative_error`, whose parameters come first.

    Parameters
    ----------
    noise : goniosim.sums.Paths or goniosim.sums.Batches or None
        How the noise of the cells hangs together; None where nothing tells.
    bias : float or None
        What nodes may be off by, in sr^-1/2.

    Returns
    -------
    float
        Infinite where it is unknown, as there.
    """
    margin = _margin(of, stderr, projected_solid_angle, noise)
    wide, total = stderr * margin[:, None, None], (total[0], total[1] * margin)
    found = relative_error(of, energy, wide, total, projected_solid_angle, weights)
    whole = float(norm(energy, projected_solid_angle) @ weights)
    return math.hypot(found, bias / whole) if bias and whole > 0.0 else found


def _margin(of, stderr, size, noise):
    """By channel, what the true error over the standard error stays below in nine of ten runs."""
    if of == "cells":
        return np.ones(len(stderr))
    freedom = np.ones(len(stderr))
    if of == "slice" and noise is not None:
        each = np.divide(stderr**2, size, out=np.zeros_like(stderr), where=size > 0.0)
        squares = (each**2).sum(axis=(1, 2)) + noise.of_squares(size)
        # A sum of so many independent squares scatters like the squared norm of the error.
        np.divide(each.sum(axis=(1, 2)) ** 2, squares, out=freedom, where=squares > 0.0)
    freedom = np.maximum(freedom, 1.0)
    # Paulson (1942): cube roots of means of squares are nearly normal. The standard error is known by scatter only.
    a, b = 2.0 / (9.0 * freedom), 2.0 / (9.0 * freedom * (np.inf if noise is None else noise.freedom))
    z2 = NINE_OF_TEN**2
    spread = np.sqrt(z2 * (a * (1.0 - b) ** 2 + b * (1.0 - a) ** 2 - z2 * a * b))
    return (((1.0 - a) * (1.0 - b) + spread) / ((1.0 - b) ** 2 - z2 * b)) ** 1.5


def fall(paths, noise, independent):
    """How a noise falls with the number N of light paths: the s of N^-s, by the last two checkpoints.

    Parameters
    ----------
    paths, noise : sequence of float
        At the checkpoints.
    independent : bool
        Whether the light paths are.

    Returns
    -------
    float
        Between `INDEPENDENT` and `FASTEST`: the noise of two checkpoints is not known well enough to believe more.
    """
    if independent or len(paths) < 2 or not paths[-1] > paths[-2] > 0.0 or not noise[-2] > noise[-1] > 0.0:
        return INDEPENDENT
    return min(max(math.log(noise[-2] / noise[-1]) / math.log(paths[-1] / paths[-2]), INDEPENDENT), FASTEST)


def paths_for(target, error, off, paths, slope):
    """Light paths that a target takes in all.

    Parameters
    ----------
    target, error : float
        What is asked for, and the `bound` that is held against it after so many ``paths``.
    off : float
        What nodes may be off by, which is part of both; relative, as they are.
    slope : float
        See `fall`.

    Returns
    -------
    float
        No less than ``paths``; infinite where what nodes may be off by leaves no room.
    """
    if error <= target:
        return float(paths)
    if off >= target:
        return math.inf
    # No squares, which would underflow.
    there, asked = (math.log10(each - off) + math.log10(each + off) for each in (error, target))
    places = 0.5 * (there - asked) / slope
    return paths * 10.0 ** min(places, _MOST_PLACES)


def norm(energy, projected_solid_angle):
    """Root of the integral of the squared BSDF times cos(theta) over the valid cells, as in Eq. 4, Bati et al. 2019.

    Parameters
    ----------
    energy : ndarray, shape (..., rows, columns)
    projected_solid_angle : ndarray, shape (rows, columns)
        In sr; 0 for cells that are not valid.

    Returns
    -------
    ndarray, shape (...), in sr^-1/2
    """
    valid = projected_solid_angle > 0.0
    squares = np.divide(energy**2, projected_solid_angle, out=np.zeros_like(energy), where=valid)
    return np.sqrt(squares.sum(axis=(-2, -1)))


def _of_cells(energy, stderr):
    values, errors = energy.ravel(), stderr.ravel()
    order = np.argsort(-values, kind="stable")
    sums = np.cumsum(values[order])
    if sums[-1] <= 0.0:
        return 0.0
    bright = order[: 1 + int(np.searchsorted(sums, BRIGHT * sums[-1]))]
    return float(np.percentile(errors[bright] / values[bright], PERCENTILE))


def _over(error, value):
    return np.divide(error, value, out=np.zeros_like(error), where=value > 0.0)


def _mean(error, value, weights):
    """Mean over the channels that are seen."""
    seen = value > FAINTEST
    return float(error[seen] @ weights[seen] / weights[seen].sum()) if seen.any() else math.inf
