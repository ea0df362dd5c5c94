"""Error bars of cells that few deposits reach.

The scatter of a handful of replicates says little where only some of them reach a cell: it is too small most of the
time, and 0 if none did. What is lit so dimly varies little from cell to cell, and neighbours tell. Only the variance
is mended, never the mean, and only there: elsewhere its neighbours would blur a narrow lobe. Which neighbours are
lit alike, and are alike in size, the parametrization of the slice tells (`goniosim.slices`).
"""

import numpy as np

# A standard error above this share of the value is not to be trusted by itself.
_UNCERTAIN = 0.15


def mended(mean, variance, reach):
    """Variances, replaced by the mean over the cells around where a cell had few hits, or none.

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
    few = (variance > (_UNCERTAIN * mean) ** 2) | (mean == 0.0)
    return np.where(few, _mean_around(variance, reach), variance)


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
