"""Ticks of logarithmic axes: few, round, and never on top of each other."""

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from ..drawing import tone

# Up to so many decades, 2 and 5 have labels as well; from so many on, the marks between decades go.
FEW, MANY = 2.5, 7.0


def logarithmic(axes, which, low, high):
    """Make an axis logarithmic.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    which : str
        ``x`` or ``y``.
    low, high : float
        Its limits, 0 < low < high.
    """
    decades = np.log10(high / low)
    axes.set(**{f"{which}scale": "log", f"{which}lim": (low, high)})
    axis = getattr(axes, f"{which}axis")
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if decades <= FEW else (1.0,), numticks=9))
    axis.set_major_formatter(FuncFormatter(_label))
    axis.set_minor_locator(LogLocator(subs=np.arange(2.0, 10.0), numticks=99) if decades < MANY else NullLocator())
    axis.set_minor_formatter(NullFormatter())


def _label(value, _):
    return tone.label(value)
