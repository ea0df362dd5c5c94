"""Score statistics: is one parameter right of the law that cells were tallied by, and how small an error of it shows.

A chi-square spreads its power over all cells. Where a parameter is off by a small share e, cells change by
``e * slope``, slope = d mean / d log(parameter), and the sum of the deviations with weights in proportion to slope over
variance tells e more sharply than any other sum (Rao's score).
"""

from dataclasses import dataclass

import numpy as np
from scipy import stats

# Of a right law fewer are rejected, of one that is off by `Score.smallest` fewer accepted.
FALSE_ALARM = 1e-10
MISSED = 1e-3


@dataclass(frozen=True)
class Score:
    """A weighted sum of deviations from a law.

    Attributes
    ----------
    deviation, stderr : float
        The parameter found over the one expected, less 1, to first order; and its standard error.
    limit : float
        Standard errors by which a right one deviates with a probability of `FALSE_ALARM`, to either side.
    """

    deviation: float
    stderr: float
    limit: float

    @property
    def sigmas(self):
        """The deviation in standard errors."""
        return self.deviation / self.stderr

    @property
    def right(self):
        """Whether the parameter can be what is expected."""
        return abs(self.sigmas) < self.limit

    @property
    def smallest(self):
        """The relative error of the parameter that is rejected with a probability of 1 - `MISSED`."""
        return (self.limit + stats.norm.isf(MISSED)) * self.stderr

    def __str__(self):
        return f"{self.sigmas:+.2f} sigma, off by {self.deviation:+.2e}; an error of {self.smallest:.2e} is seen"


def score_of_paths(observed, mean, second_moment, slope, rays):
    """The score of independent paths, each of which deposits in one cell at most.

    Parameters
    ----------
    observed, mean, second_moment : ndarray of the same shape
        As of `chi_square.chi_square`.
    slope : ndarray
        Derivative of the mean by the logarithm of the parameter.
    rays : int

    Returns
    -------
    Score
    """
    weights = _weights(second_moment, slope)
    variance = ((weights**2 * second_moment).sum() - (weights * mean).sum() ** 2) / rays
    per_change = (weights * slope).sum()
    limit = stats.norm.isf(0.5 * FALSE_ALARM)
    return Score((weights * (observed - mean)).sum() / per_change, np.sqrt(variance) / per_change, limit)


def score_of_replicates(replicates, mean, second_moment, slope):
    """The score of independent replicates, whose scatter tells its error.

    Parameters
    ----------
    replicates : ndarray, shape (count, ...)
        What each found in the cells.
    mean, second_moment, slope : ndarray, shape (...)
        As of `score_of_paths`; the second moment decides on the weights alone.

    Returns
    -------
    Score
    """
    weights = _weights(second_moment, slope)
    count = len(replicates)
    found = (weights * (replicates - mean)).reshape(count, -1).sum(axis=1)
    per_change = (weights * slope).sum()
    limit = stats.t.isf(0.5 * FALSE_ALARM, count - 1)
    return Score(found.mean() / per_change, found.std(ddof=1) / np.sqrt(count) / per_change, limit)


def pooled(scores):
    """The score of one parameter by independent tests of it, each counted by its sharpness."""
    weights = np.array([each.stderr**-2.0 for each in scores])
    deviation = (weights * [each.deviation for each in scores]).sum() / weights.sum()
    return Score(deviation, weights.sum() ** -0.5, max(each.limit for each in scores))


def _weights(second_moment, slope):
    return np.divide(slope, second_moment, out=np.zeros_like(slope), where=second_moment > 0.0)
