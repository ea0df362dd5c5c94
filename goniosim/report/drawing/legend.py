"""The heading of a figure: its title, and one legend for all its panels."""

import textwrap

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from . import panels

# Inches; letters are about so wide: a bold one of size 1, one of a caption.
TITLE, LEGEND, CAPTION, LETTER, CAPTION_LETTER = 0.36, 0.5, 0.1, 0.0098, 0.064
LARGEST = 14.0


def title(figure, words):
    """Write the title into the upper left corner, as large as the figure is wide enough for."""
    width, height = figure.get_size_inches()
    size = min(LARGEST, (width - 0.4) / (LETTER * len(words)))
    figure.text(0.2 / width, 1.0 - TITLE / height, words, fontsize=size, fontweight="bold")


def caption(figure, words, middle=None):
    """Write below everything, in as many lines as it takes.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    words : str
    middle : float, optional
        Where its middle stands, in inches from the left; in the middle of the figure by default.
    """
    width, height = figure.get_size_inches()
    x = 0.5 if middle is None else middle / width
    lines = textwrap.wrap(words, int((width - 0.3) / CAPTION_LETTER))
    figure.text(x, CAPTION / height, "\n".join(lines), ha="center", va="bottom", fontsize=8.5, color="0.3")


def add(figure, planes, invalid, dirac):
    """Explain lines, noise and marks below the title.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    planes : list of matplotlib.axes.Axes
        Axes with curves; lines of the same name are listed once.
    invalid : bool
        Whether some cells have no value.
    dirac : bool
        Whether some light leaves in exactly one direction.
    """
    lines = {label: line for axes in planes for line, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    handles = [lines[label] for label in sorted(lines, key=lambda label: (len(label), "RGB".find(label)))]
    handles += [
        Patch(facecolor=panels.INK, alpha=0.25, label=f"± {panels.BAND_SIGMAS:g} standard errors"),
        Line2D([], [], label="light", linestyle="", marker="v", markersize=7, **panels.LIGHT_STYLE),
        Line2D([], [], label="straight on (mirror direction)", **panels.STRAIGHT_ON),
    ]
    if dirac:
        ring = {"marker": "o", "markersize": 8, "markerfacecolor": "none", "color": panels.DIRAC}
        handles.append(Line2D([], [], label="one exact direction", linestyle="", **ring))
    if invalid:
        handles.append(Patch(facecolor=panels.INVALID_GREY, label="cell cut by the horizon: no value"))
    below_title(figure, handles, ncols=len(handles), fontsize=8.5, columnspacing=1.3, handlelength=1.5)


def below_title(figure, handles, **look):
    """Write a legend into the upper left corner of a figure, below its title."""
    width, height = figure.get_size_inches()
    figure.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0.2 / width, 1.0 - LEGEND / height),
        borderpad=0.0,
        borderaxespad=0.0,
        frameon=False,
        handletextpad=0.5,
        **look,
    )
