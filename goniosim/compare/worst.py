"""The worst cell: the one that adds most to the error, among those whose deviation is no noise.

Many cells are looked at, and the largest of many deviations is large by chance alone. So a cell is
significant only beyond what any of N would show in one case of twenty: z standard errors with
N P(|x| > z) = 5 %, and, if no path hit it, an expectation of more than 3 + log(N) hits (the rule of three
for N cells). The standard error is the larger one of what the hits say and of what a true model
expects.
"""

from statistics import NormalDist

import numpy as np

from .counts import RULE_OF_THREE

FALSE_ALARM = 0.05


def worst_cells(d, s2, size, expected, looked_at, negligible):
    """Find the worst cell of each channel in one direction.

    Parameters
    ----------
    d, s2 : ndarray, shape (C, R, K)
        Model minus reference in 1/sr, and the squared standard error of the reference.
    size : ndarray, shape (R, K)
        Projected solid angles, 0 in cells that do not count.
    expected : goniosim.compare.counts.Expected or None
        None for a component that is not sampled.
    looked_at : int
        Cells among which a worst one is sought, over all directions and channels.
    negligible : ndarray, shape (C,)
        What no cell may fall below: a squared error that is rounding.

    Returns
    -------
    row, column : ndarray of int, shape (C,)
        -1 where no cell is significant.
    excess : ndarray, shape (C,)
        What the cell adds to the debiased squared error; 0 where there is none.
    """
    z = NormalDist().inv_cdf(1.0 - 0.5 * FALSE_ALARM / looked_at)
    d2 = d * d
    if expected is None:
        significant = d2 > z**2 * s2
    else:
        significant = d2 > z**2 * np.maximum(s2, expected.variance)
        missed = expected.n > RULE_OF_THREE + np.log(looked_at)
        significant = np.where(expected.hit, significant, missed)
    excess = (significant * size * (d2 - s2)).reshape(len(d), -1)
    best = np.argmax(excess, axis=1)
    excess = excess[np.arange(len(d)), best]
    found = excess > negligible
    row, column = np.divmod(best, d.shape[-1])
    return np.where(found, row, -1), np.where(found, column, -1), np.where(found, excess, 0.0)
