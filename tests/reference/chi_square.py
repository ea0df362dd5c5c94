"""Chi-square test of tallied cells against their exact means and second moments."""

from dataclasses import dataclass

import numpy as np
from scipy import stats

# Cells in which fewer paths are expected are pooled until there are that many.
ENOUGH_PATHS = 20.0


@dataclass(frozen=True)
class ChiSquare:
    """A chi-square statistic.

    Attributes
    ----------
    per_dof : float
    sigmas : float
        Its distance from 1 as the quantile of a normal distribution with the same tail.
    dof : int
        Cells after pooling.
    """

    per_dof: float
    sigmas: float
    dof: int


def chi_square(observed, mean, second_moment, rays):
    """Compare the energy tallied in cells with its distribution.

    A path deposits a random weight in one cell at most, so that the variance
    of a cell is (second_moment - mean^2) / rays and the covariance of two cells
    is - mean mean' / rays.

    Parameters
    ----------
    observed, mean, second_moment : ndarray of the same shape
        Energy found in each cell; expectation of a path's deposit and of its square.
    rays : int

    Returns
    -------
    ChiSquare
    """
    observed, mean, second_moment = (np.ravel(a) for a in (observed, mean, second_moment))
    # A cell that can have no energy joins the sparsest pool: what is found there all the same counts.
    paths = np.divide(rays * mean**2, second_moment, out=np.zeros_like(mean), where=second_moment > 0.0)
    pool = _pools(paths)
    observed, mean, second_moment = (np.bincount(pool, a) for a in (observed, mean, second_moment))

    variance = (second_moment - mean**2) / rays
    deviations2 = (observed - mean) ** 2 / variance
    count = len(deviations2)
    # Variance of the sum of squares of correlated normal deviates, plus that of the fourth
    # cumulants of the compound Poisson counts.
    q = mean**2 / (second_moment - mean**2)
    spread = 2.0 * (count + q.sum() ** 2 - (q**2).sum()) + (second_moment / mean**2 / rays).sum()
    # Satterthwaite: a scaled chi-square distribution with the same mean and variance.
    dof = 2.0 * count**2 / spread
    statistic = deviations2.sum() * dof / count
    above = stats.chi2.sf(statistic, dof)
    sigmas = stats.norm.isf(above) if above < 0.5 else stats.norm.ppf(stats.chi2.cdf(statistic, dof))
    return ChiSquare(per_dof=deviations2.sum() / count, sigmas=float(sigmas), dof=count)


def _pools(paths):
    """Number of the pool that each cell belongs to: from the emptiest cells up, until it is full."""
    pool = np.empty(len(paths), dtype=int)
    number, filled = 0, 0.0
    for cell in np.argsort(paths):
        pool[cell] = number
        filled += paths[cell]
        if filled >= ENOUGH_PATHS:
            number, filled = number + 1, 0.0
    # What remains unfilled at the end joins the last full pool.
    return np.minimum(pool, max(number - 1, 0))
