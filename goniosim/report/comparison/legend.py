"""One legend for all panels of a figure of models, below its title."""

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..drawing import letters, panels
from ..drawing.legend import EDGE, LEGEND, below_title, height
from . import labels, style

# Inches.
LIST_LINE, SAMPLE = 0.21, 0.45
SIZE = 8.0
LIST_TEXT = {"va": "center_baseline", "parse_math": False}
NOISE = f"± {panels.BAND_SIGMAS:g} standard errors"


def height_needed(figure_width, handles):
    """Height in inches of title and legend."""
    names = [handle.get_label() for handle in handles]
    return LEGEND + height(names, SIZE, figure_width - 2.0 * EDGE) + 0.12


def place(figure, handles):
    """Write the legend into the upper left corner, below the title."""
    below_title(figure, handles, size=SIZE)


def curves(entries, twins):
    """Legend of the curves of the simulation, with its noise, and of the models.

    Parameters
    ----------
    entries : list of goniosim.report.comparison.entries.Entry
    twins : list of (Entry or None)
        For each the entry that covers it, see `entries.twins`.

    Returns
    -------
    list of matplotlib.artist.Artist
    """
    handles = [
        Line2D([], [], label=labels.with_twin(entry, twin), **look)
        for entry, twin, look in zip(entries, twins, style.lines(entries), strict=True)
    ]
    if entries[0].model is None:
        handles.insert(1, Patch(facecolor=style.BAND, label=NOISE))
    return handles


def list_height(entries):
    """Height in inches of a list of curves."""
    return LIST_LINE * (len(entries) + 1)


def place_list(figure, left, top, width, entries, twins):
    """Write a list of curves, each with its error.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    left, top, width : float
        In inches.
    entries : list of goniosim.report.comparison.entries.Entry
    twins : list of (Entry or None)
        As in `curves`.
    """
    axes = panels.place(figure, left, top, width, list_height(entries))
    axes.set_axis_off()
    axes.set_xlim(0.0, width)
    axes.set_ylim(len(entries) + 0.5, -0.5)
    if any(entry.error for entry in entries):
        words = f"RMSE of this direction [{labels.UNIT}]"
        axes.text(width, 0, words, ha="right", va="center_baseline", fontsize=SIZE, color="0.3")
    room = width - SAMPLE - 0.3 - max(letters.width(entry.error, SIZE) for entry in entries)
    for line, (entry, twin, look) in enumerate(zip(entries, twins, style.lines(entries), strict=True), 1):
        label = labels.with_twin(entry, twin)
        if entry.model is None:
            label += f", {NOISE}"
            axes.fill_between([0.0, SAMPLE], line - 0.3, line + 0.3, color=style.BAND, linewidth=0.0)
        axes.plot([0.0, 0.5 * SAMPLE, SAMPLE], [line] * 3, markevery=[1], **look)
        label, size = letters.snug(label, SIZE, room)
        look = {"va": "center", "linespacing": 1.0} if "\n" in label else {}
        axes.text(SAMPLE + 0.12, line, label, fontsize=size, **LIST_TEXT | look)
        axes.text(width, line, entry.error, ha="right", fontsize=SIZE, color="0.3", **LIST_TEXT)
