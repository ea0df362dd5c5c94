"""One incident direction of a material, as in Figs. 5 to 9 of Bati et al. 2019: lobes, and views from above."""

from matplotlib.figure import Figure

from ..drawing import panels, tone
from ..drawing.bands import bar
from ..drawing.disks import ASPECT, Board
from ..drawing.legend import caption, title
from . import half_disk, labels, legend, style
from .scale import Scale

PIXELS = 160
# Inches. On the left the lobes, with the list of models below; on the right two views of each entry.
LEFT, GAP, COLUMNS = 0.25, 0.3, 5
LOBES, LOBES_OF_MANY = 5.0, 6.6
TOP, NAME, BETWEEN, ERROR, FOOTER = 0.55, 0.42, 0.05, 0.3, 0.55
LIST_GAP, BAR, BAR_ROOM = 0.2, 0.14, 0.75
DISK = 1.42
STEP = DISK * ASPECT
CELL = NAME + 2 * DISK + BETWEEN + ERROR


def direction_figure(name, component, direction):
    """Draw the simulation and the models in one direction.

    Parameters
    ----------
    name : str
        Of the material.
    component : str
    direction : goniosim.report.comparison.entries.Direction

    Returns
    -------
    matplotlib.figure.Figure
    """
    entries = direction.entries
    columns = min(COLUMNS, len(entries))
    rows = -(-len(entries) // columns)
    lobes = LOBES if rows == 1 else LOBES_OF_MANY
    lobes_height = half_disk.ASPECT * lobes
    right = LEFT + lobes + GAP
    width = right + columns * STEP + BAR_ROOM
    height = TOP + max(rows * CELL, lobes_height + LIST_GAP + legend.list_height(entries)) + FOOTER
    figure = Figure(figsize=(width, height), dpi=style.DISKS_DPI)
    title(figure, f"{name},  {component},  light at {direction.angle}°")
    half_disk.draw(panels.place(figure, LEFT, TOP, lobes, lobes_height), direction, size=1.25)
    legend.place_list(figure, LEFT, TOP + lobes_height + LIST_GAP, lobes, entries)
    board, scale = Board(figure), Scale(direction, PIXELS)
    for number, entry in enumerate(entries):
        row, column = divmod(number, columns)
        left, top = right + column * STEP, TOP + row * CELL + NAME
        colour, bands = board.disk(left, top, DISK), board.disk(left, top + DISK + BETWEEN, DISK)
        scale.draw_colour(colour, entry)
        scale.draw_bands(bands, entry)
        labels.above(colour, entry)
        labels.below(bands, entry)
    if scale.bands is not None:
        left, top = right + columns * STEP + 0.12, TOP + NAME + DISK + BETWEEN
        axes = panels.place(figure, left, top, BAR, DISK)
        bar(axes, scale.bands, fontsize=7)
        axes.set_title("1/sr", fontsize=7, pad=4)
    white = tone.label(float(f"{scale.white:.2g}"))
    views = f"colour by log(1 + √f), white at {white} /sr, and luminance; rings at 30° and 60°{scale.explanation}"
    caption(figure, f"Left: {half_disk.SCALE}.  Right: {views}{labels.explanation([direction])}.")
    return figure
