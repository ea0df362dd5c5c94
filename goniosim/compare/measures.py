"""How far a model is from a noisy reference: Eq. 4 of Bati et al. 2019, with the noise taken out.

In one channel and direction, with d = model - reference, s the standard error of the reference and
w the projected solid angle of a cell, over the valid cells:

    squared  = sum w d^2                  the integral under the root of Eq. 4
    noise    = sum w s^2                  what the noise alone adds to it
    debiased = squared - noise            expectation: the squared error of the model

With delta the model's true error and V the covariance of the noise of the cells, the variance of ``debiased`` is

    4 sum w_i delta_i V_ij w_j delta_j  +  2 sum w_i w_j V_ij^2:

exact for a Gaussian, and for hits of equal weight, which are Poissonian. The diagonal, sum w^2 (4 delta^2 s^2 + 2
s^4), is estimated from d and s; where s enters it is that of the mirror-image cell, which has the same expectation but
is not correlated with this one's d. (A cell that holds Dirac light has no such twin.) The first sum then holds the
second twice, since d has the noise in it. What lies off the diagonal is known, because a path leaves in one cell only,
or comes from batches: see `goniosim.sums`, as for the errors of the albedo. If the noise itself is estimated from f + 1
batches, ``noise`` has the variance (2 / f) sum w_i w_j V_ij^2. Where hits are few or absent it is taken from the
model, see `counts`.
"""

from dataclasses import dataclass, fields

import numpy as np

from .counts import RULE_OF_THREE, Expected
from .worst import worst_cells

# A debiased squared error is told from noise if it exceeds so many standard errors of that of a true
# model: one true model in 44 is called wrong, one in 20 where only a few cells count.
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
    unseen, unseen_squared : ndarray
        Where no path hit the component in the channel: hits that a true model expects, and how much of ``squared`` is
        due to them; 0 elsewhere.
    hidden : ndarray
        Squared error that unhit cells may hide, in 1/sr.
    norm : ndarray
        Integral of the squared reference, without its noise, in 1/sr.
    albedo_reference, albedo_stderr, albedo_model : ndarray
        Energy in the valid cells, and the standard error of that of the reference: half of what
        the rule of three allows where there was no hit.
    worst_row, worst_column : ndarray of int
        The cell that adds most to the debiased squared error, see `worst`; -1 if none is significant.
    worst_excess : ndarray
        What it adds, in 1/sr.
    worst_difference, worst_stderr : ndarray
        Model minus reference there, and the standard error of the reference, in 1/sr.
    """

    squared: np.ndarray
    noise: np.ndarray
    variance: np.ndarray
    variance_if_true: np.ndarray
    unseen: np.ndarray
    unseen_squared: np.ndarray
    hidden: np.ndarray
    norm: np.ndarray
    albedo_reference: np.ndarray
    albedo_stderr: np.ndarray
    albedo_model: np.ndarray
    worst_row: np.ndarray
    worst_column: np.ndarray
    worst_excess: np.ndarray
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


def measure(model, reference, stderr, cells, counts=None):
    """Compare slices.

    Parameters
    ----------
    model, reference, stderr : ndarray, shape (M, C, R, K)
        BSDF in 1/sr, and the standard error of the reference.
    cells : goniosim.result.Cells
    counts : goniosim.compare.counts.Counts, optional
        None for a reference that is not sampled.

    Returns
    -------
    Measures
    """
    looked_at = max(int(cells.valid.sum()) * model.shape[1], 1)
    rows = []
    for m, slices in enumerate(zip(model, reference, stderr, strict=True)):
        size = cells.projected_solid_angle[m] * cells.valid[m]
        expected = None
        if counts is not None:
            expected = Expected(*slices, size, counts, m)
        rows.append(_one_direction(*slices, size, expected, looked_at))
    names = [field.name for field in fields(Measures)]
    return Measures(**{name: np.stack(values) for name, values in zip(names, zip(*rows, strict=True), strict=True)})


def _one_direction(model, reference, stderr, size, expected, looked_at):
    """Entries of `Measures` for slices (C, R, K); ``size`` is 0 in cells that do not count."""
    d = model - reference
    d2, s2 = d * d, stderr * stderr
    other_s2 = s2[..., ::-1]
    if expected is not None:
        other_s2 = np.where(expected.lonely, s2, other_s2)
    squared, noise = _total(size * d2), _total(size * s2)
    from_hits = 2.0 * size**2 * s2 * other_s2
    if_true, few = _total(from_hits), np.zeros(len(d))
    gradient = _total(4.0 * size**2 * d2 * other_s2)
    norm = np.maximum(_total(size * (reference**2 - s2)), 0.0)
    albedo_variance = _total(size**2 * s2)
    unseen, unseen_squared, hidden = np.zeros((3, len(d)))
    pairs = of_noise = 0.0
    if expected is not None and expected.noise is not None:
        valid = size > 0.0
        pairs = 2.0 * expected.noise.of_squares(size)
        of_noise = (if_true + pairs) / expected.noise.freedom
        # The derivative of w d^2 by the energy; d holds the noise too.
        gradient = gradient + expected.noise.of_sum(2.0 * d * valid, 2.0 * noise)
        albedo_variance = np.maximum(albedo_variance + expected.noise.of_sum(valid), 0.0)
    variance = gradient - if_true - pairs + of_noise
    albedo_stderr = np.sqrt(albedo_variance)
    if expected is not None:
        hidden = expected.hidden
        dark = expected.unseen
        unseen = np.where(dark, _total(expected.n), 0.0)
        unseen_squared = np.where(dark, _total(size * d2 * (d > 0.0)), 0.0)
        albedo_stderr = np.where(dark, np.maximum(albedo_stderr, 0.5 * RULE_OF_THREE * expected.per_hit), albedo_stderr)
        if_seen, few_seen = expected.variance_if_true(from_hits)
        if_true, few = np.where(dark, if_true, if_seen), np.where(dark, few, few_seen)
    if_true = if_true + pairs + of_noise
    # By chance the estimate may fall below what even a true model has; far below it is no estimate.
    variance = np.maximum(variance, few + 0.25 * (if_true - few))
    row, column, excess = worst_cells(d, s2, size, expected, looked_at, ROUNDING**2 * norm)
    channel = np.arange(len(d))
    return (
        squared,
        noise,
        variance,
        if_true,
        unseen,
        unseen_squared,
        hidden,
        norm,
        _total(size * reference),
        albedo_stderr,
        _total(size * model),
        row,
        column,
        excess,
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
    explained = _explained(measures.unseen[pick], measures.unseen_squared[pick])
    sigma = np.sqrt(variance.sum(axis=0)) / len(variance)
    limit = SIGNIFICANT * np.sqrt(if_true.sum(axis=0)) / len(if_true) + explained
    hidden = measures.hidden[pick].max(axis=0) / len(variance)
    norm = measures.norm[pick].mean(axis=0)
    if channel is not None:
        squared, noise, norm = squared[[channel]], noise[[channel]], norm[[channel]]
        sigma, limit, hidden, explained = sigma[[channel]], limit[[channel]], hidden[[channel]], explained[[channel]]
    debiased = squared - noise
    error = np.sqrt(np.maximum(debiased, 0.0))
    upper = np.sqrt(np.maximum(debiased, 0.0) + SIGNIFICANT * sigma + hidden)
    return Error(
        rmse=float(error.mean()),
        stderr=float(_stderr(debiased, sigma + explained / SIGNIFICANT).mean()),
        upper=float(upper.mean()),
        raw=float(np.sqrt(squared).mean()),
        noise_floor=float(np.sqrt(noise).mean()),
        significant=bool(debiased.mean() > (limit + ROUNDING**2 * norm).mean() * (1.0 + ROUNDING)),
    )


def _explained(unseen, unseen_squared):
    """How much of the mean squared error (C,) is explained by what went unseen, see `counts`; arguments (M, C)."""
    expected = unseen.sum(axis=0)
    share = RULE_OF_THREE / np.maximum(expected, RULE_OF_THREE)
    return share * (2.0 - share) * unseen_squared.mean(axis=0)


def _stderr(squared, sigma):
    """Standard error of a root: sigma / (2 root), and where that diverges the reach of one sigma."""
    root = np.sqrt(np.maximum(squared, 0.0))
    reach = np.sqrt(np.maximum(squared, 0.0) + sigma) - root
    clear = squared > SIGNIFICANT * sigma
    return np.where(clear, sigma / (2.0 * np.where(clear, root, 1.0)), reach)
