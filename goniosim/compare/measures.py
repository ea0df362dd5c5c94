"""How far a model is from a noisy reference: Eq. 4 of Bati et al. 2019, with the noise taken out.

In one channel and direction, with d = model - reference, s the standard error of the reference and
w the projected solid angle of a cell, over the valid cells:

    squared  = sum w d^2                  the integral under the root of Eq. 4
    noise    = sum w s^2                  what the noise alone adds to it
    debiased = squared - noise            expectation: the squared error of the model

The noise of a cell is independent of that of the others, so the variance of ``debiased`` is
sum w^2 (4 delta^2 s^2 + 2 s^4), with delta the model's true error: exact for a Gaussian, and for
hits of equal weight, which are Poissonian. It is estimated from d and s; where s enters it is that
of the mirror-image cell, which has the same expectation but is not correlated with this one's d.
"""

from dataclasses import dataclass, fields

import numpy as np

# A debiased squared error is told from noise if it exceeds so many standard errors of that of a true
# model: one true model in 44 is called wrong, a few more where only a few cells count.
SIGNIFICANT = 2.0
# Share of the norm of the reference below which an error is rounding: references are not more exact.
ROUNDING = 1e-8


@dataclass(frozen=True)
class Measures:
    """Comparison of a model with a reference; arrays of shape (M, C).

    Attributes
    ----------
    squared, noise, variance, variance_if_true : ndarray
        See above; ``variance`` is that of ``squared - noise``, and ``variance_if_true`` what it
        would be with delta = 0. In 1/sr, 1/sr, 1/sr^2 and 1/sr^2.
    norm : ndarray
        Integral of the squared reference, without its noise, in 1/sr.
    albedo_reference, albedo_stderr, albedo_model : ndarray
        Energy in the valid cells, and the standard error of that of the reference.
    worst_row, worst_column : ndarray of int
        The cell that adds most to the debiased squared error.
    worst_difference, worst_stderr : ndarray
        Model minus reference there, and the standard error of the reference, in 1/sr.
    """

    squared: np.ndarray
    noise: np.ndarray
    variance: np.ndarray
    variance_if_true: np.ndarray
    norm: np.ndarray
    albedo_reference: np.ndarray
    albedo_stderr: np.ndarray
    albedo_model: np.ndarray
    worst_row: np.ndarray
    worst_column: np.ndarray
    worst_difference: np.ndarray
    worst_stderr: np.ndarray


@dataclass(frozen=True)
class Error:
    """An RMSE with what is known about it, in 1/sr^(1/2).

    Attributes
    ----------
    rmse : float
        Debiased; 0 if less than the noise was seen.
    stderr : float
        Standard error of ``rmse``.
    upper : float
        The true error lies below with 97.7 % confidence.
    raw : float
        Eq. 4 as it stands, noise included.
    noise_floor : float
        What Eq. 4 would give for the true model.
    significant : bool
        Whether ``rmse`` is told from noise and from rounding.
    """

    rmse: float
    stderr: float
    upper: float
    raw: float
    noise_floor: float
    significant: bool


def measure(model, reference, stderr, cells):
    """Compare slices.

    Parameters
    ----------
    model, reference, stderr : ndarray, shape (M, C, R, K)
        BSDF in 1/sr, and the standard error of the reference.
    cells : goniosim.result.Cells

    Returns
    -------
    Measures
    """
    rows = [
        _one_direction(*slices, cells.projected_solid_angle[m] * cells.valid[m])
        for m, slices in enumerate(zip(model, reference, stderr, strict=True))
    ]
    names = [field.name for field in fields(Measures)]
    return Measures(**{name: np.stack(values) for name, values in zip(names, zip(*rows, strict=True), strict=True)})


def _one_direction(model, reference, stderr, size):
    """Entries of `Measures` for slices (C, R, K); ``size`` is 0 in cells that do not count."""
    d = model - reference
    d2, s2 = d * d, stderr * stderr
    other_s2 = s2[..., ::-1]
    squared, noise = _total(size * d2), _total(size * s2)
    if_true = _total(2.0 * size**2 * s2 * other_s2)
    # By chance the estimate may fall below what even a true model has; far below it is no estimate.
    variance = np.maximum(_total(4.0 * size**2 * d2 * other_s2) - if_true, 0.25 * if_true)
    columns = d.shape[-1]
    worst = np.argmax((size * (d2 - s2)).reshape(len(d), -1), axis=1)
    channel = np.arange(len(d))
    row, column = np.divmod(worst, columns)
    return (
        squared,
        noise,
        variance,
        if_true,
        np.maximum(_total(size * (reference**2 - s2)), 0.0),
        _total(size * reference),
        np.sqrt(_total(size**2 * s2)),
        _total(size * model),
        row,
        column,
        d[channel, row, column],
        stderr[channel, row, column],
    )


def _total(values):
    return values.sum(axis=(-2, -1))


def rmse(measures, direction=None, channel=None):
    """The error of Eq. 4.

    Parameters
    ----------
    measures : Measures
    direction : int, optional
        Of one direction only; all of them by default.
    channel : int, optional
        In one channel only; by default the mean of the errors of the channels. Channels share their
        paths, so their errors are taken to be fully correlated.

    Returns
    -------
    Error
    """
    pick = slice(None) if direction is None else slice(direction, direction + 1)
    squared, noise = measures.squared[pick].mean(axis=0), measures.noise[pick].mean(axis=0)
    variance, if_true = measures.variance[pick], measures.variance_if_true[pick]
    sigma = np.sqrt(variance.sum(axis=0)) / len(variance)
    sigma_if_true = np.sqrt(if_true.sum(axis=0)) / len(if_true)
    norm = measures.norm[pick].mean(axis=0)
    if channel is not None:
        squared, noise, norm = squared[[channel]], noise[[channel]], norm[[channel]]
        sigma, sigma_if_true = sigma[[channel]], sigma_if_true[[channel]]
    debiased = squared - noise
    error = np.sqrt(np.maximum(debiased, 0.0))
    limit = SIGNIFICANT * sigma_if_true.mean() + ROUNDING**2 * norm.mean()
    upper = np.sqrt(np.maximum(debiased, 0.0) + SIGNIFICANT * sigma)
    return Error(
        rmse=float(error.mean()),
        stderr=float(_stderr(debiased, sigma).mean()),
        upper=float(upper.mean()),
        raw=float(np.sqrt(squared).mean()),
        noise_floor=float(np.sqrt(noise).mean()),
        significant=bool(debiased.mean() > limit),
    )


def _stderr(squared, sigma):
    """Standard error of a root: sigma / (2 root), and where that diverges the reach of one sigma."""
    root = np.sqrt(np.maximum(squared, 0.0))
    reach = np.sqrt(np.maximum(squared, 0.0) + sigma) - root
    clear = squared > SIGNIFICANT * sigma
    return np.where(clear, sigma / (2.0 * np.where(clear, root, 1.0)), reach)
