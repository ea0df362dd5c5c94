"""The heading of a figure: its title, and one legend for all its panels."""

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from . import panels

# Inches.
TITLE, LEGEND = 0.36, 0.5
# Names longer than this are written smaller.
LONG_TITLE = 60


def title(figure, words):
    """Write the title into the upper left corner."""
    size = 14.0 * min(1.0, LONG_TITLE / len(words))
    width, height = figure.get_size_inches()
    figure.text(0.2 / width, 1.0 - TITLE / height, words, fontsize=size, fontweight="bold")


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
    width, height = figure.get_size_inches()
    figure.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0.2 / width, 1.0 - LEGEND / height),
        borderpad=0.0,
        borderaxespad=0.0,
        ncols=len(handles),
        fontsize=8.5,
        frameon=False,
        columnspacing=1.3,
        handlelength=1.5,
        handletextpad=0.5,
    )
