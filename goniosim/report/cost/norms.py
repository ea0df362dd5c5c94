"""Norms of slices as in Eq. 4 of Bati et al. 2019, mean over the channels.

The norm of f is the root of the integral of f^2 cos(theta_v).
"""

import numpy as np


def noise_of(component, cells):
    """Norm of the standard error of every slice, shape (M,), in 1/sr^(1/2)."""
    return _norm(component.bsdf_stderr**2, cells)


def norm_of(component, cells):
    """Norm of every slice without what its noise adds, shape (M,), in 1/sr^(1/2)."""
    return _norm(component.bsdf**2 - component.bsdf_stderr**2, cells)


def _norm(squares, cells):
    size = np.where(cells.valid, cells.projected_solid_angle, 0.0)[:, None]
    return np.sqrt(np.maximum((size * squares).sum(axis=(2, 3)), 0.0)).mean(axis=1)


def difference(away, variance, reference, size):
    """Relative norm of a noisy difference.

    Parameters
    ----------
    away, variance : ndarray, shape (C, ...)
        The difference in each cell, and the variance of its noise.
    reference : ndarray, shape (C, ...)
        Squares of the slice, an estimate without bias.
    size : ndarray, shape (...)
        Projected solid angle of the cells; 0 where they do not count.

    Returns
    -------
    error, uncertainty : float
        The norm of the difference over that of the slice, its noise taken out, and its standard error.
    """
    axes = tuple(range(1, away.ndim))
    norm = np.maximum((size * reference).sum(axis=axes), 1e-300)
    square = (size * (away**2 - variance)).sum(axis=axes) / norm
    unknown = np.sqrt((size**2 * (4.0 * away**2 * variance + 2.0 * variance**2)).sum(axis=axes)) / norm
    root = np.sqrt(np.maximum(square, 0.0))
    # Where nothing is told from noise, the reach of one standard error of the square.
    stderr = np.where(square > unknown, unknown / (2.0 * np.maximum(root, 1e-300)), np.sqrt(unknown))
    return float(root.mean()), float(stderr.mean())
