"""Bands of equal luminance: their edges, their colours, and the bar that explains them."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap

from . import tone, view


def extent(slices, numbers):
    """Luminance that the bands of a slice should cover.

    Parameters
    ----------
    slices : ndarray, shape (C, R, K)
        BSDF in 1/sr.
    numbers : ndarray of int64, shape (pixels, pixels)
        From `view.disk`.

    Returns
    -------
    tuple of float, or None
        In 1/sr; None if the slice is black.
    """
    shown = tone.luminance(view.pixel_values(slices, numbers))
    lit = shown[shown > 0.0]
    return tuple(np.quantile(lit, (0.02, 0.9995))) if lit.size else None


def scale(low, high):
    """Choose bands between round values.

    Parameters
    ----------
    low, high : float
        In 1/sr.

    Returns
    -------
    matplotlib.cm.ScalarMappable
    """
    levels = tone.levels(low, high)
    colours = ListedColormap(colormaps["viridis"](np.linspace(0.0, 1.0, len(levels) + 1)))
    # One band below the first level and one above the last.
    edges = [min(0.0, levels[0]), *levels, 1.5 * levels[-1]]
    return ScalarMappable(BoundaryNorm(edges, colours.N), colours)


def bar(axes, scale, fontsize=8):
    """Explain the bands in axes of their own, narrow and high."""
    colour_bar = axes.figure.colorbar(scale, cax=axes)
    levels = scale.norm.boundaries[1:-1]
    colour_bar.set_ticks(levels, labels=[tone.label(level) for level in levels])
    colour_bar.minorticks_off()
    colour_bar.ax.tick_params(length=0, labelsize=fontsize)
    colour_bar.outline.set_visible(False)
