"""One legend for all panels of a figure of models, below its title."""

from matplotlib.lines import Line2D

from ..drawing.legend import LEGEND
from . import style

# Inches.
ENTRY_WIDTH, LINE_HEIGHT = 2.45, 0.19


def lines_needed(figure_width, count):
    """Lines of a legend with so many entries, for a figure of that width in inches."""
    return -(-count // _columns(figure_width))


def height_needed(figure_width, count):
    """Height in inches of title and legend."""
    return LEGEND + LINE_HEIGHT * lines_needed(figure_width, count) + 0.12


def place(figure, handles):
    """Write the legend into the upper left corner, below the title."""
    width, height = figure.get_size_inches()
    figure.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0.2 / width, 1.0 - LEGEND / height),
        borderpad=0.0,
        borderaxespad=0.0,
        ncols=_columns(width),
        fontsize=8,
        frameon=False,
        columnspacing=1.2,
        labelspacing=0.35,
        handlelength=1.8,
        handletextpad=0.5,
    )


def curve(variant):
    """Legend entry of a model drawn as a line."""
    look = {"color": style.colour(variant), "linestyle": style.line_style(variant)}
    return Line2D([], [], label=variant.label, **look)


def _columns(figure_width):
    return max(2, int((figure_width - 0.4) / ENTRY_WIDTH))
