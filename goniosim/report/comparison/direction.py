"""One incident direction of a material, as in Figs. 5 to 9 of Bati et al. 2019: lobes, and views from above."""

import numpy as np
from matplotlib.figure import Figure

from ..drawing import panels, tone, zoom
from ..drawing.bands import bar
from ..drawing.disks import ASPECT, Board
from ..drawing.legend import caption, caption_height, title
from . import half_disk, labels, legend, style
from .entries import twins
from .scale import Scale

PIXELS = 160
# Inches. On the left the lobes, with the list of models below; on the right two views of each entry.
LEFT, GAP, COLUMNS = 0.25, 0.3, 5
LOBES, LOBES_OF_MANY = 5.0, 6.6
TOP, NAME, LINE, BETWEEN, ERROR = 0.55, 0.2, 0.125, 0.05, 0.3
LIST_GAP, BAR, BAR_ROOM = 0.2, 0.14, 0.75
# A closer look at a narrow lobe, below the half disk: room for its scales, its height, and what it takes in all.
NEAR_LEFT, NEAR_HEIGHT, NEAR = 0.75, 1.7, 2.3
DISK = 1.42
STEP = DISK * ASPECT


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
    name_room = NAME + LINE * labels.lines(entries, STEP - 0.06)
    cell = name_room + 2 * DISK + BETWEEN + ERROR
    near = NEAR if direction.scaling.narrow else 0.0
    scale = Scale(direction, PIXELS)
    words = _explanation(direction, scale)
    height = TOP + max(rows * cell, lobes_height + near + LIST_GAP + legend.list_height(entries))
    height += caption_height(words, width)
    figure = Figure(figsize=(width, height), dpi=style.DISKS_DPI)
    title(figure, f"{name},  {component},  light at {direction.angle}°")
    half_disk.draw(panels.place(figure, LEFT, TOP, lobes, lobes_height), direction, size=1.25)
    if near:
        _closer(panels.place(figure, NEAR_LEFT, TOP + lobes_height + 0.15, lobes - 0.6, NEAR_HEIGHT), direction)
    covered = twins([direction], [half_disk.tolerance(direction, lobes)])
    legend.place_list(figure, LEFT, TOP + lobes_height + near + LIST_GAP, lobes, entries, covered)
    board = Board(figure)
    for number, entry in enumerate(entries):
        row, column = divmod(number, columns)
        left, top = right + column * STEP, TOP + row * cell + name_room
        colour, bands = board.disk(left, top, DISK), board.disk(left, top + DISK + BETWEEN, DISK)
        scale.draw_colour(colour, entry)
        scale.draw_bands(bands, entry)
        labels.above(colour, entry, STEP - 0.06)
        labels.below(bands, entry, STEP - 0.06)
    if scale.bands is not None:
        left, top = right + columns * STEP + 0.12, TOP + name_room + DISK + BETWEEN
        axes = panels.place(figure, left, top, BAR, DISK)
        bar(axes, scale.bands, fontsize=7)
        axes.set_title("1/sr", fontsize=7, pad=4)
    caption(figure, words)
    return figure


def _explanation(direction, scale):
    white = tone.label(float(f"{scale.white:.2g}"))
    views = f"colour by log(1 + √f), white at {white} /sr, and luminance; rings at 30° and 60°{scale.explanation()}"
    return f"Left: {half_disk.SCALE}. Right: {views}{labels.explanation([direction])}."


def _closer(axes, direction):
    """The curves near the peak of a narrow lobe, over the angle."""
    low, high = direction.scaling.narrow
    top = direction.scaling.highest * half_disk.HEADROOM**2
    looks = style.lines(direction.entries)
    for number, (entry, look) in enumerate(zip(direction.entries, looks, strict=True)):
        inside = (entry.angle > low) & (entry.angle < high)
        apart = max(int(inside.sum()) // 6, 1)
        every = (np.flatnonzero(inside)[:1].sum() + number * apart // len(looks), apart)
        if entry.model is None:
            f, sigma = np.nan_to_num(entry.f), panels.BAND_SIGMAS * entry.sigma
            band = tone.remap(f - sigma), tone.remap(f + sigma)
            axes.fill_between(entry.angle, *band, color=style.BAND, linewidth=0.0, zorder=2)
        axes.plot(entry.angle, tone.remap(entry.f), zorder=5 if entry.model is None else 3, markevery=every, **look)
    ticks = tone.axis_ticks(top, 0.12)
    axes.set_ylim(0.0, tone.remap(top))
    axes.set_yticks(tone.remap(np.array(ticks)), [tone.label(value) for value in ticks])
    zoom.furnish(axes, (low, high), direction.theta_deg)
    axes.set_ylabel("1/sr", fontsize=8)
    axes.set_xlabel("the lobe enlarged: view angle in the plane of incidence [deg]", fontsize=8, labelpad=2)
