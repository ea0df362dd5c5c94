"""Curves in the plane of incidence, and what all panels share: colours, places, the Dirac part."""

import numpy as np

from .. import text
from . import tone

INVALID_GREY = (0.62, 0.62, 0.62)
INK = "#333333"
LIGHT = "#ffc400"
LIGHT_STYLE = {"color": LIGHT, "markeredgecolor": INK, "markeredgewidth": 0.7}
DIRAC = "#ff5fd2"
STRAIGHT_ON = {"color": "0.55", "linewidth": 0.9, "linestyle": (0, (4, 3))}
CHANNEL_COLOURS = {
    "R": "#d1242f",
    "G": "#2a9d3a",
    "B": "#2563c9",
    "RG": "#a37a00",
    "RB": "#8e3bb0",
    "GB": "#0f8a93",
    "RGB": INK,
}
OTHER_COLOURS = ("#333333", "#b8860b", "#7b3fa0", "#008b8b")
BAND_SIGMAS = 2.0


def place(figure, left, top, width, height):
    """Add axes to a figure, placed in inches from its upper left corner."""
    full_width, full_height = figure.get_size_inches()
    return figure.add_axes(
        (left / full_width, 1.0 - (top + height) / full_height, width / full_width, height / full_height)
    )


def curves(axes, channels, angle, f, sigma, sampled):
    """Draw the BSDF along the plane of incidence, one line per channel with its noise.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    channels : list of str
    angle, f, sigma : ndarray
        From `inplane.plane_of_incidence`.
    sampled : bool
        Whether nothing seen leaves a gap; an integrated component is really zero there.
    """
    for order, (name, c) in enumerate(text.channel_groups(channels, [f, sigma])):
        colour = channel_colour(name, c)
        low, high = (tone.remap(f[:, c] + sign * BAND_SIGMAS * sigma[:, c]) for sign in (-1.0, 1.0))
        seen = (f[:, c] > 0.0) | (not sampled)
        axes.fill_between(angle, low, high, where=seen, color=colour, alpha=0.25, linewidth=0.0)
        line = np.where(seen, tone.remap(f[:, c]), np.nan)
        # Later lines are thinner, so that those that nearly agree are all seen.
        axes.plot(angle, line, color=colour, linewidth=1.6 - 0.35 * order, label=" = ".join(name))


def plane_axes(axes, theta_deg, highest, spacing=0.09):
    """Finish the axes of `curves`: angles, remapped scale, the light and the direction straight on.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    theta_deg : float
    highest : float
        Highest BSDF to be shown, in 1/sr.
    spacing : float
        Least distance of two ticks, as a share of the axis.
    """
    top = highest if highest > 0.0 else 1.0
    ticks = tone.axis_ticks(top, spacing)
    axes.set_xlim(-90.0, 90.0)
    axes.set_xticks(range(-90, 91, 30))
    axes.set_ylim(0.0, 1.08 * tone.remap(top))
    axes.set_yticks(tone.remap(np.array(ticks)), [tone.label(value) for value in ticks])
    axes.grid(color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.axvline(theta_deg, zorder=1, **STRAIGHT_ON)
    axes.plot(
        [-theta_deg],
        [1.0],
        marker="v",
        markersize=7,
        transform=axes.get_xaxis_transform(),
        clip_on=False,
        zorder=5,
        **LIGHT_STYLE,
    )


def dirac_cell(component, direction):
    """Number of the cell that holds light leaving in exactly one direction, or None."""
    if not component.contains_delta:
        return None
    return int(np.argmax(component.energy[direction].sum(axis=0)))


def without_cell(slices, number):
    """Copy of slices (C, R, K) in which a cell is dark, so that a Dirac part sets no scale."""
    copy = slices.copy()
    if number is not None:
        copy.reshape(len(copy), -1)[:, number] = 0.0
    # If there is no other light, the Dirac part has to set the scale after all.
    return copy if copy.any() else slices


def channel_colour(name, c):
    """Colour of the line of a group of channels whose first is number ``c``."""
    return CHANNEL_COLOURS.get(name, OTHER_COLOURS[c % len(OTHER_COLOURS)])
