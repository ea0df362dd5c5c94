"""How BSDF values become brightness, colour and axis positions: everything is remapped by log(1 + sqrt f).

The remapping is that of Figs. 5 to 9 of Bati et al. 2019; it shows peaks and faint lobes at once.
"""

import numpy as np
from matplotlib.ticker import MaxNLocator

# Relative luminance of linear RGB, ITU-R BT.709.
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])

# Share of the pixels that may be brighter than white: a narrow peak must not darken all the rest.
OVEREXPOSED = 0.005
# Least brightness of white, as a share of the brightest pixel (both remapped).
FAINTEST_WHITE = 0.15


def remap(f):
    """Remap BSDF values in 1/sr by log(1 + sqrt f); negative ones count as zero."""
    return np.log1p(np.sqrt(np.maximum(f, 0.0)))


def rgb(f):
    """Make colours of BSDF values.

    Parameters
    ----------
    f : ndarray, shape (..., C)
        Anything but three channels is shown as their mean, in grey.

    Returns
    -------
    ndarray, shape (..., 3)
    """
    if f.shape[-1] == 3:
        return f
    return np.repeat(f.mean(axis=-1, keepdims=True), 3, axis=-1)


def luminance(f):
    """Luminance of BSDF values of shape (..., C)."""
    return rgb(f) @ LUMINANCE


def white_point(f):
    """BSDF value to be shown at full brightness, in 1/sr.

    Parameters
    ----------
    f : ndarray, shape (P, C)
        Values of the visible pixels.

    Returns
    -------
    float
        Positive.
    """
    brightest = f.max(axis=-1)
    if not np.any(brightest > 0.0):
        return 1.0
    remapped = remap(brightest)
    # The second term is for lobes narrower than the share that may be too bright.
    white = max(np.quantile(remapped, 1.0 - OVEREXPOSED), FAINTEST_WHITE * remapped.max())
    return float(np.expm1(white) ** 2)


def exposed(f, white):
    """Remapped colours in [0, 1] of BSDF values of shape (..., C), for a given white point."""
    return np.clip(remap(rgb(f)) / remap(white), 0.0, 1.0)


def levels(low, high, most=12):
    """Choose round BSDF values between two, as the edges of bands of colour.

    Parameters
    ----------
    low, high : float
        Range in 1/sr, 0 < low <= high.
    most : int
        Number of levels not to exceed.

    Returns
    -------
    ndarray
        Ascending, at least one: evenly spaced for a narrow range, otherwise the densest of the
        series 1-1.5-2-3-5-7, 1-2-5, 1-3 and 1 per decade that has not too many.
    """
    if high < 1.2 * low:
        digit = 10.0 ** np.floor(np.log10(low))
        return np.array([np.floor(low / digit) * digit])
    if high < 8.0 * low:
        values = MaxNLocator(nbins=most - 1, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
        return values[values > 0.0][:most]
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    for series in ([1, 1.5, 2, 3, 5, 7], [1, 2, 5], [1, 3], [1]):
        values = np.outer(decades, series).ravel()
        values = values[(values >= low) & (values <= high)]
        if len(values) <= most:
            return values
    return values[-most:]


def axis_ticks(high, spacing):
    """Choose round BSDF values from 0 to ``high``, a share ``spacing`` of a remapped axis apart."""
    decades = 10.0 ** np.arange(np.ceil(np.log10(high)), np.floor(np.log10(high)) - 7, -1)
    chosen = []
    for value in np.outer(decades, [5, 2, 1]).ravel():
        above = remap(chosen[-1]) if chosen else np.inf
        if value <= high and min(above - remap(value), remap(value)) >= spacing * remap(high):
            chosen.append(float(value))
    return [0.0, *reversed(chosen)]


def label(value):
    """Write a BSDF value for a scale: ``0.05``, ``200``, ``1e5``."""
    if value == 0.0 or 1e-3 <= value < 1e4:
        return f"{value:.4g}"
    mantissa, exponent = f"{value:.2e}".split("e")
    return f"{float(mantissa):g}e{int(exponent)}"
