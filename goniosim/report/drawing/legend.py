"""The heading of a figure: its title, and one legend for all its panels."""

import numpy as np
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from . import letters, panels

# Inches.
TITLE, LEGEND, EDGE = 0.36, 0.5, 0.2
CAPTION, CAPTION_EDGE, CAPTION_LINE = 0.1, 0.15, 0.155
# A title of two lines begins higher and ends lower.
TWO_LINES = 0.07
# Points.
LARGEST = 14.0
SIZE, CAPTION_SIZE = 8.5, 8.5
# Of a legend, in units of its letters.
HANDLE, PAD, SPACING, LABELS, LINE = 1.8, 0.5, 1.3, 0.35, 1.45


def title(figure, words):
    """Write the title into the upper left corner, as large as there is room for, in two lines if need be."""
    width, height = figure.get_size_inches()
    room = width - 2.0 * EDGE
    words, size = letters.snug(words, LARGEST, room, bold=True)
    baseline = TITLE + (TWO_LINES if "\n" in words else 0.0)
    figure.text(
        EDGE / width,
        1.0 - baseline / height,
        words,
        fontsize=size,
        fontweight="bold",
        linespacing=1.1,
        parse_math=False,
    )


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
    middle = 0.5 * width if middle is None else middle
    lines = _lines(words, 2.0 * min(middle, width - middle))
    look = {"ha": "center", "va": "bottom", "fontsize": CAPTION_SIZE, "color": "0.3", "parse_math": False}
    figure.text(middle / width, CAPTION / height, "\n".join(lines), **look)


def caption_height(words, width):
    """Height in inches of a caption in the middle of a figure of a width in inches, with room above it."""
    return 2.0 * CAPTION + CAPTION_LINE * len(_lines(words, width))


def _lines(words, width):
    lines, room = [""], width - 2.0 * CAPTION_EDGE
    for word in words.split(" "):
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and letters.width(longer, CAPTION_SIZE) > room:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def add(figure, planes, *, invalid, dirac, unseen, enlarged=False):
    """Explain lines, noise and marks below the title, in two lines at most.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    planes : list of matplotlib.axes.Axes
        Axes with curves; lines of the same name are listed once.
    invalid : bool
        Whether some cells have no value.
    dirac : bool
        Whether some light leaves in exactly one direction.
    unseen : bool
        Whether some cells were not hit once.
    enlarged : bool
        Whether a range of angles is shown twice.
    """
    lines = {label: line for axes in planes for line, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    handles = [lines[label] for label in sorted(lines, key=lambda label: (len(label), "RGB".find(label)))]
    if len(handles) > panels.MOST_NAMED:
        # One line for each of many channels: those between have the colours between.
        handles = [handles[n] for n in np.linspace(0, len(handles) - 1, panels.MOST_NAMED).round().astype(int)]
    handles += [
        Patch(facecolor=panels.INK, alpha=0.25, label=f"± {panels.BAND_SIGMAS:g} standard errors"),
        Line2D([], [], label="light", linestyle="", marker="v", markersize=7, **panels.LIGHT_STYLE),
        Line2D([], [], label="straight on (mirror direction)", **panels.STRAIGHT_ON),
    ]
    if enlarged:
        handles.append(Patch(label="enlarged beside it", **panels.ENLARGED))
    if dirac:
        ring = {"marker": "o", "markersize": 8, "markerfacecolor": "none", "color": panels.DIRAC}
        handles.append(Line2D([], [], label="one exact direction", linestyle="", **ring))
    if unseen:
        handles.append(_unseen())
    if invalid:
        handles.append(invalid_patch("cell cut by the horizon: no value"))
    below_title(figure, handles, rows=2)


def invalid_patch(label):
    """What cells without a value look like."""
    return Patch(
        facecolor=panels.INVALID_GREY, edgecolor=panels.INVALID_STRIPE, hatch="/////", linewidth=0.0, label=label
    )


def _unseen():
    patches = [Patch(facecolor=colour, edgecolor="0.5", linewidth=0.5) for colour in panels.UNSEEN]
    return Together(patches, "no hit: not seen (curves: gap)")


class Together(tuple):
    """Several artists of a legend under one label."""

    def __new__(cls, artists, label):
        """Remember the label beside the artists."""
        made = super().__new__(cls, artists)
        made.label = label
        return made

    def get_label(self):
        """As other artists have it."""
        return self.label


def layout(labels, size, room, rows=None):
    """Arrange the labels of a legend.

    Parameters
    ----------
    labels : list of str
    size : float
        Of the letters in points, at most.
    room : float
        Width in inches.
    rows : int, optional
        No more than so many, at the price of smaller letters.

    Returns
    -------
    columns : int
    size : float
        In points; smaller only where a single column would be too wide, or ``rows`` too few.
    """
    most = len(labels)
    fewest = 1 if rows is None else -(-most // rows)
    for columns in range(most, fewest - 1, -1):
        # Where fewer columns have as many rows, the last row would hold little more than the first column.
        filled = -(-most // columns)
        if -(-most // filled) == columns and _width(labels, size, columns) <= room:
            return columns, size
    columns = max(fewest, 1)
    return columns, 0.98 * size * min(1.0, room / _width(labels, size, columns))


def height(labels, size, room):
    """Height in inches of a legend, see `layout`."""
    columns, size = layout(labels, size, room)
    return LINE * size / letters.POINTS * -(-len(labels) // columns)


def below_title(figure, handles, rows=None, size=SIZE):
    """Write a legend into the upper left corner of a figure, below its title, no wider than the figure."""
    width, full = figure.get_size_inches()
    labels = [handle.get_label() for handle in handles]
    columns, size = layout(labels, size, width - 2.0 * EDGE, rows)
    drawn = figure.legend(
        handles=[tuple(handle) if isinstance(handle, Together) else handle for handle in handles],
        labels=labels,
        loc="upper left",
        bbox_to_anchor=(EDGE / width, 1.0 - LEGEND / full),
        borderpad=0.0,
        borderaxespad=0.0,
        frameon=False,
        ncols=columns,
        fontsize=size,
        handlelength=HANDLE,
        handletextpad=PAD,
        columnspacing=SPACING,
        labelspacing=LABELS,
        handler_map={tuple: HandlerTuple(ndivide=None, pad=0.0)},
    )
    for words in drawn.get_texts():
        words.set_parse_math(False)


def _width(labels, size, columns):
    """In inches; columns are filled as matplotlib does it."""
    split = np.array_split(np.array(labels, dtype=object), columns)
    words = sum(max(letters.width(label, size) for label in column) for column in split)
    return words + size * (columns * (HANDLE + PAD) + (columns - 1) * SPACING) / letters.POINTS
