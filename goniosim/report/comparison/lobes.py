"""Lobes in the plane of incidence, all directions side by side: the simulation and the models."""

from matplotlib.figure import Figure

from ..drawing import panels
from ..drawing.legend import caption, caption_height, title
from . import entries, half_disk, legend

# Inches.
WIDTH, COLUMNS, MARGIN, ROOM = 3.5, 4, 0.25, 0.5
HEIGHT = half_disk.ASPECT * WIDTH


def lobes_figure(name, component, directions):
    """Draw the luminance in the plane of incidence, one half disk per direction.

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
    columns = min(COLUMNS, max(len(directions), 2))
    rows = -(-len(directions) // columns)
    width = MARGIN + columns * (WIDTH + MARGIN)
    twins = entries.twins(directions, [half_disk.tolerance(direction, WIDTH) for direction in directions])
    handles = legend.curves(directions[0].entries, twins)
    narrow = any(direction.scaling.narrow for direction in directions)
    words = half_disk.SCALE + ("; narrow lobes: enlarged in the figure of each direction" if narrow else "")
    top = legend.height_needed(width, handles)
    figure = Figure(figsize=(width, top + rows * (HEIGHT + ROOM) + caption_height(words, width)))
    title(figure, f"{name},  {component} in the plane of incidence")
    legend.place(figure, handles)
    for number, direction in enumerate(directions):
        row, column = divmod(number, columns)
        left, down = MARGIN + column * (WIDTH + MARGIN), top + row * (HEIGHT + ROOM) + 0.2
        axes = panels.place(figure, left, down, WIDTH, HEIGHT)
        half_disk.draw(axes, direction)
        axes.set_title(f"{direction.angle}°", fontsize=10, pad=3, loc="left")
    caption(figure, words)
    return figure
