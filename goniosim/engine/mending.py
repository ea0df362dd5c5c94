"""Error bars of cells that few deposits reach.

The scatter of a handful of replicates says little where only some of them reach a cell: it is too small most of the
time, and 0 if none did. What a deposit brings varies little from cell to cell where there is little light, and
neighbours tell: the sum of their variances over the sum of their means is the grain g, and a mean m made of such
grains has the variance g m, as if it were that of m / g deposits. Only the variance is mended, never the mean, and only
there: elsewhere its neighbours would blur a narrow lobe. Which neighbours are alike, the parametrization of the slice
tells (`goniosim.slices`).
"""

import numpy as np

# A standard error above this share of the value is not to be trusted by itself.
_UNCERTAIN = 0.15
# Between these shares the neighbours decide whether it is above that. Who replaces a scatter for being large keeps the
# small ones, and states on average less than there is: a quarter of the variance, next to the limit.
_WELL_KNOWN, _UNKNOWN = 0.08, 0.25
# Of so many deposits and fewer the mean itself is known too badly to tell the variance: the neighbours' goes in.
_FEW = 8.0


def mended(mean, variance, reach):
    """Variances, replaced by what neighbours tell where a cell had few hits, or none.

    Parameters
    ----------
    mean : ndarray, shape (..., rows, width)
        On the columns that tell all of a slice, see `plan.Plan.width`.
    variance : ndarray
        Variance of the mean by scatter; same shape.
    reach : tuple of int
        Rows and columns to each side.

    Returns
    -------
    ndarray
        A new array. At both ends of a row neighbours are mirrored; rows beyond the first and the last are left out.
    """
    light, scatter = _mean_around(mean, reach), _mean_around(variance, reach)
    grain = np.divide(scatter, light, out=np.zeros_like(scatter), where=light > 0.0)
    deposits = np.divide(mean, grain, out=np.zeros_like(mean), where=grain > 0.0)
    share = deposits**4 / (deposits**4 + _FEW**4)
    told = share * grain * mean + (1.0 - share) * scatter
    few = (variance > (_UNKNOWN * mean) ** 2) | (mean == 0.0)
    doubtful = (variance > (_WELL_KNOWN * mean) ** 2) & (grain > _UNCERTAIN**2 * mean)
    return np.where(few | doubtful, told, variance)


def _mean_around(values, reach):
    rows, columns = reach
    total = _sums(values, values.ndim - 1, columns, "symmetric")
    total = _sums(total, values.ndim - 2, rows, "constant")
    present = _sums(np.ones(values.shape[-2]), 0, rows, "constant")
    return total / (present[:, None] * (2 * columns + 1))


def _sums(values, axis, reach, beyond):
    """Sums over neighbours along an axis; ``beyond`` is the ``mode`` of `numpy.pad`."""
    margins = [(0, 0)] * values.ndim
    margins[axis] = (reach, reach)
    padded = np.pad(values, margins, mode=beyond)
    # Sums of few numbers instead of differences of running sums: a bright cell leaves no rounding error behind.
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis=axis)
    return windows.sum(axis=-1)
