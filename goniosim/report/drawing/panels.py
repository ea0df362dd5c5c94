"""The panels of which figures are made: top view in colour, top view in bands, curve in the plane."""

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Circle, FancyArrowPatch
from matplotlib.patheffects import withStroke

from .. import text
from . import tone, view

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

# Room around the unit disk, and the shape of the axes that follows from it.
MARGIN, ARROW_TAIL = 1.04, 1.3
DISK_ASPECT = (ARROW_TAIL + MARGIN) / (2.0 * MARGIN)
DISK_CENTRE = ARROW_TAIL / (ARROW_TAIL + MARGIN)


def place(figure, left, top, width, height):
    """Add axes to a figure, placed in inches from its upper left corner."""
    full_width, full_height = figure.get_size_inches()
    return figure.add_axes(
        (left / full_width, 1.0 - (top + height) / full_height, width / full_width, height / full_height)
    )


def top_view(axes, slices, numbers, theta_deg, white, spot=None):
    """Draw a slice as the eye sees it from above, in remapped colours.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    slices : ndarray, shape (C, R, K)
        BSDF in 1/sr.
    numbers : ndarray of int64, shape (pixels, pixels)
        From `view.disk`.
    theta_deg : float
        Where the light stands.
    white : float
        BSDF shown at full brightness, in 1/sr.
    spot : ndarray of 3 floats, optional
        Direction of a Dirac part, to be ringed: its cell may be too small to be seen.
    """
    _show(axes, tone.exposed(pixel_values(slices, numbers), white), numbers)
    _furnish(axes, theta_deg, spot)


def band_view(axes, slices, numbers, theta_deg, spot=None):
    """Draw the luminance of a slice from above, in bands of false colours between round values.

    Parameters
    ----------
    axes, slices, numbers, theta_deg, spot
        As in `top_view`.

    Returns
    -------
    matplotlib.cm.ScalarMappable or None
        For the colour bar; None if the slice is black.
    """
    shown = tone.luminance(pixel_values(slices, numbers))
    lit = shown[shown > 0.0]
    scale = None
    colours = np.zeros((*shown.shape, 3))
    if lit.size:
        levels = tone.levels(np.quantile(lit, 0.02), np.quantile(lit, 0.9995))
        bands = ListedColormap(colormaps["turbo"](np.linspace(0.04, 0.96, len(levels) + 1)))
        # One band below the first level and one above the last.
        edges = [min(0.0, levels[0]), *levels, 1.5 * levels[-1]]
        scale = ScalarMappable(BoundaryNorm(edges, bands.N), bands)
        colours = scale.to_rgba(np.minimum(shown, 1.2 * levels[-1]))[..., :3]
    _show(axes, colours, numbers)
    _furnish(axes, theta_deg, spot)
    return scale


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


def pixel_values(slices, numbers):
    """BSDF of every pixel, shape (pixels, pixels, C); zero where there is no valid cell."""
    by_cell = slices.reshape(len(slices), -1).T
    return np.where(numbers[..., None] >= 0, by_cell[np.maximum(numbers, 0)], 0.0)


def channel_colour(name, c):
    """Colour of the line of a group of channels whose first is number ``c``."""
    return CHANNEL_COLOURS.get(name, OTHER_COLOURS[c % len(OTHER_COLOURS)])


def _show(axes, colours, numbers):
    image = np.dstack([colours, numbers != view.OUTSIDE])
    image[numbers == view.INVALID, :3] = INVALID_GREY
    axes.imshow(image, extent=(-1.0, 1.0, -1.0, 1.0), interpolation="antialiased")


def _furnish(axes, theta_deg, spot):
    """Rim, rings at 30 and 60 degrees, the light as an arrow outside and a ring where it stands."""
    axes.set_axis_off()
    axes.set_xlim(-ARROW_TAIL, MARGIN)
    axes.set_ylim(-MARGIN, MARGIN)
    for ring in (30.0, 60.0):
        axes.add_patch(Circle((0, 0), np.sin(np.radians(ring)), fill=False, color="white", alpha=0.35, linewidth=0.6))
    axes.add_patch(Circle((0, 0), 1.0, fill=False, color=INK, linewidth=1.2))
    if spot is not None:
        axes.plot([-spot[0]], [-spot[1]], "o", markersize=9, markerfacecolor="none", color=DIRAC, clip_on=False)
    where = -np.sin(np.radians(theta_deg))
    axes.plot(
        [where],
        [0.0],
        "o",
        markersize=7,
        markerfacecolor="none",
        color=LIGHT,
        markeredgewidth=1.5,
        path_effects=[withStroke(linewidth=2.8, foreground=INK)],
    )
    if theta_deg > 0.0:
        axes.add_patch(
            FancyArrowPatch(
                (-ARROW_TAIL, 0.0),
                (-1.03, 0.0),
                arrowstyle="simple,head_length=6,head_width=8,tail_width=2.5",
                facecolor=LIGHT,
                edgecolor=INK,
                linewidth=0.7,
                shrinkA=0.0,
                shrinkB=0.0,
            )
        )
