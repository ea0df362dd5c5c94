"""Curves in the plane of incidence, and what all panels share: colours, places, the Dirac part."""

import numpy as np
from matplotlib import colormaps
from matplotlib.patheffects import withStroke

from .. import text
from . import letters, tone

# Cells without a value are hatched, so that no grey of a picture looks like them.
INVALID_GREY, INVALID_STRIPE = (0.62, 0.62, 0.62), (0.78, 0.78, 0.78)
# Cells that no path hit: in pictures in colour, and among bands.
UNSEEN = ((0.15, 0.18, 0.27), (0.93, 0.93, 0.93))
INK = "#333333"
LIGHT = "#ffc400"
LIGHT_STYLE = {"color": LIGHT, "markeredgecolor": INK, "markeredgewidth": 0.7}
DIRAC = "#ff5fd2"
STRAIGHT_ON = {"color": "0.55", "linewidth": 0.9, "linestyle": (0, (4, 3))}
# Colour and dash of a channel: each of them tells the channels apart, also where their curves coincide.
CHANNEL_LOOKS = {
    "R": ("#d1242f", "-"),
    "G": ("#009e73", (0, (5.0, 2.5))),
    "B": ("#2563c9", (0, (1.3, 2.2))),
    "RG": ("#a37a00", (0, (7.0, 2.0, 1.3, 2.0))),
    "RB": ("#8e3bb0", (0, (7.0, 2.0, 1.3, 2.0))),
    "GB": ("#0f8a93", (0, (7.0, 2.0, 1.3, 2.0))),
    "RGB": (INK, "-"),
}
# For other channels; their colours run from dark to bright.
OTHER_DASHES = ("-", (0, (5.0, 2.5)), (0, (1.3, 2.2)), (0, (7.0, 2.0, 1.3, 2.0)))
MOST_NAMED = 12
BAND_SIGMAS = 2.0
# The range of angles that a closer look shows.
ENLARGED = {"facecolor": "#ffc400", "alpha": 0.25, "linewidth": 0.0}


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
    groups = text.channel_groups(channels, [f, sigma])
    # The bands of many channels would hide each other.
    alpha = min(0.25, 0.75 / len(groups))
    single = all(len(channel) == 1 for channel in channels)
    for order, (name, c) in enumerate(groups):
        colour, dash = channel_look(name, c, len(channels))
        low, high = (tone.remap(f[:, c] + sign * BAND_SIGMAS * sigma[:, c]) for sign in (-1.0, 1.0))
        seen = (f[:, c] > 0.0) | (not sampled)
        axes.fill_between(angle, low, high, where=seen, color=colour, alpha=alpha, linewidth=0.0)
        line = np.where(seen, tone.remap(f[:, c]), np.nan)
        label = " = ".join(name if single else name.split("+"))
        # Later lines are thinner, so that those that nearly agree are all seen.
        width = max(1.7 - 0.15 * order, 0.9)
        axes.plot(angle, line, color=colour, linewidth=width, linestyle=dash, label=label)
        alone = isolated(line)
        axes.plot(angle[alone], line[alone], color=colour, linestyle="", marker=".", markersize=4.0)


def isolated(line):
    """Numbers of the points of a line between two gaps (NaN): a line does not show them."""
    gap = np.isnan(np.concatenate([[np.nan], line, [np.nan]]))
    return np.flatnonzero(~gap[1:-1] & gap[:-2] & gap[2:])


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


def unseen_cells(components, cells, direction):
    """Cells that no path is known to have hit and that no integration lights.

    Parameters
    ----------
    components : list of goniosim.result.Component
        Shown as one.
    cells : goniosim.result.Cells
    direction : int

    Returns
    -------
    ndarray of bool, shape (R, K), or None
        None if nothing is sampled, or every valid cell was hit.
    """
    if not any(component.sampled for component in components):
        return None
    hits = [component.hits[direction] for component in components if component.hits is not None]
    dark = np.all([component.energy[direction].max(axis=0) <= 0.0 for component in components], axis=0)
    unseen = dark & np.all([number == 0 for number in hits], axis=0) & cells.valid[direction]
    return unseen if unseen.any() else None


def coinciding(curves, tolerance):
    """Curves that nowhere differ by more than a tolerance from earlier ones.

    Parameters
    ----------
    curves : sequence of (ndarray, ndarray)
        Ascending places and heights of each curve; NaN where it has a gap.
    tolerance : float
        In the units of the heights.

    Returns
    -------
    list of set of int
        For each curve the earlier ones that it coincides with.
    """
    return [
        {earlier for earlier in range(number) if _apart(curve, curves[earlier]) <= tolerance}
        for number, curve in enumerate(curves)
    ]


def _apart(one, other):
    """Greatest distance of two curves where there are both; infinite where only one has a gap."""
    if not np.array_equal(*(np.isnan(height).any() for _, height in (one, other))):
        return np.inf
    if np.isnan(one[1]).any():
        same = np.array_equal(np.isnan(one[1]), np.isnan(other[1])) and np.array_equal(one[0], other[0])
        return float(np.nanmax(np.abs(one[1] - other[1]), initial=0.0)) if same else np.inf
    distances = [
        np.abs(np.interp(places, *between, left=np.nan, right=np.nan) - heights)
        for between, (places, heights) in ((one, other), (other, one))
        if len(between[0])
    ]
    distances = np.concatenate([*distances, np.empty(0)])
    return float(np.nanmax(distances)) if np.isfinite(distances).any() else np.inf


def note_coinciding(axes, channels, angle, f, sigma, top, size=8.0):
    """Say in a corner of the axes of `curves` which channels cannot be told apart: ``G ≈ B``."""
    groups = text.channel_groups(channels, [f, sigma])
    if len(groups) > MOST_NAMED:
        return
    # Half a line's width, of the height of the axes in points.
    points = axes.get_position().height * axes.figure.get_figheight() * letters.POINTS
    lines = [(angle, tone.remap(f[:, c])) for _, c in groups]
    same = {}
    for (name, _), earlier in zip(groups, coinciding(lines, 0.8 / points * tone.remap(top)), strict=True):
        if earlier:
            first = groups[min(earlier)][0]
            same.setdefault(first, [first]).append(name)
    words = ", ".join(" ≈ ".join(names) for names in same.values())
    halo = [withStroke(linewidth=2.5, foreground="white")]
    look = {"fontsize": size, "color": "0.3", "parse_math": False, "path_effects": halo}
    # Below the mark of the light, which may stand in this corner.
    axes.text(0.015, 0.9, words, transform=axes.transAxes, va="top", **look)


def channel_look(name, c, count):
    """Colour and dash of the line of a group of channels whose first is number ``c`` of ``count``."""
    if name in CHANNEL_LOOKS:
        return CHANNEL_LOOKS[name]
    return colormaps["viridis"](0.9 * c / max(count - 1, 1)), OTHER_DASHES[c % len(OTHER_DASHES)]
