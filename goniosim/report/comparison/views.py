"""Top views, all directions below each other: the simulation and the models side by side."""

from matplotlib.figure import Figure

from ..drawing.disks import ASPECT, Board
from ..drawing.legend import caption, caption_height, title
from . import labels, style
from .scale import Scale

PIXELS = 160
# Inches.
DISK, LEFT, HEADER, LINE, ROW = 1.42, 0.55, 0.65, 0.125, 1.68
STEP = DISK * ASPECT


def views_figure(name, component, directions):
    """Draw a row for each direction: the simulation, then the models.

    Parameters
    ----------
    name : str
        Of the material.
    component : str
    directions : list of goniosim.report.comparison.entries.Direction

    Returns
    -------
    matplotlib.figure.Figure
    """
    entries = directions[0].entries
    width = max(LEFT + STEP * len(entries) + 0.2, 6.0)
    scales = [Scale(direction, PIXELS) for direction in directions]
    by = ", set by the simulation" if entries[0].model is None else ""
    grey = max((scale.explanation(bands=False) for scale in scales), key=len)
    words = f"colour by log(1 + √f), a scale for each row{by}{grey}{labels.explanation(directions)}"
    header = HEADER + LINE * labels.lines(entries, STEP - 0.06)
    figure = Figure(figsize=(width, header + ROW * len(directions) + caption_height(words, width)), dpi=style.DISKS_DPI)
    title(figure, f"{name},  {component}")
    height = figure.get_figheight()
    board = Board(figure)
    for row, (direction, scale) in enumerate(zip(directions, scales, strict=True)):
        top = header + ROW * row
        for column, entry in enumerate(direction.entries):
            disk = board.disk(LEFT + column * STEP, top, DISK)
            scale.draw_colour(disk, entry)
            if row == 0:
                labels.above(disk, entry, STEP - 0.06)
            labels.below(disk, entry, STEP - 0.06)
        y = 1.0 - (top + 0.5 * DISK) / height
        figure.text(0.12 / width, y, f"{direction.angle}°", fontsize=10, va="center")
    caption(figure, words)
    return figure
