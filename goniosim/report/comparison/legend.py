"""One legend for all panels of a figure of models, below its title."""

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..drawing import panels
from ..drawing.legend import LEGEND, below_title
from . import style

# Inches.
ENTRY_WIDTH, LINE_HEIGHT = 2.45, 0.19
LIST_LINE, SAMPLE = 0.21, 0.4
LIST_TEXT = {"fontsize": 8, "va": "center_baseline"}
NOISE = f"± {panels.BAND_SIGMAS:g} standard errors"


def lines_needed(figure_width, count):
    """Lines of a legend with so many entries, for a figure of that width in inches."""
    return -(-count // _columns(figure_width))


def height_needed(figure_width, count):
    """Height in inches of title and legend."""
    return LEGEND + LINE_HEIGHT * lines_needed(figure_width, count) + 0.12


def place(figure, handles):
    """Write the legend into the upper left corner, below the title."""
    below_title(
        figure,
        handles,
        ncols=_columns(figure.get_figwidth()),
        fontsize=8,
        columnspacing=1.2,
        labelspacing=0.35,
        handlelength=1.8,
    )


def curves(entries):
    """Legend of the curves of the simulation, with its noise, and of the models.

    Parameters
    ----------
    entries : list of goniosim.report.comparison.entries.Entry

    Returns
    -------
    list of matplotlib.artist.Artist
    """
    handles = [
        Line2D([], [], label=entry.label, **look) for entry, look in zip(entries, style.lines(entries), strict=True)
    ]
    if entries[0].model is None:
        handles.insert(1, Patch(facecolor=style.BAND, label=NOISE))
    return handles


def list_height(entries):
    """Height in inches of a list of curves."""
    return LIST_LINE * (len(entries) + 1)


def place_list(figure, left, top, width, entries):
    """Write a list of curves, each with its error.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    left, top, width : float
        In inches.
    entries : list of goniosim.report.comparison.entries.Entry
    """
    axes = panels.place(figure, left, top, width, list_height(entries))
    axes.set_axis_off()
    axes.set_xlim(0.0, width)
    axes.set_ylim(len(entries) + 0.5, -0.5)
    if any(entry.error for entry in entries):
        axes.text(width, 0, "RMSE of this direction [1/√sr]", ha="right", **LIST_TEXT, color="0.3")
    for line, (entry, look) in enumerate(zip(entries, style.lines(entries), strict=True), 1):
        label = entry.label
        if entry.model is None:
            label += f", {NOISE}"
            axes.fill_between([0.0, SAMPLE], line - 0.3, line + 0.3, color=style.BAND, linewidth=0.0)
        axes.plot([0.0, SAMPLE], [line, line], **look)
        axes.text(SAMPLE + 0.12, line, label, **LIST_TEXT)
        axes.text(width, line, entry.error, ha="right", **LIST_TEXT, color="0.3")


def _columns(figure_width):
    return max(2, int((figure_width - 0.4) / ENTRY_WIDTH))
