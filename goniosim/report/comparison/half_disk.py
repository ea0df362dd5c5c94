"""The panel of lobes: luminance in the plane of incidence as distance from the centre of a half disk."""

import numpy as np
from matplotlib.patches import Arc

from ..drawing import panels, tone
from . import style

# Marks along a curve: so far apart, as a share of the panel.
APART = 0.22
# Height over width of the axes.
ASPECT = 1.1 / 2.04
# Models that go far beyond the reference leave the picture: it is the reference that sets the scale.
HEADROOM = 1.35
# Half the width of a line, in inches.
LINE = 0.01
SCALE = (
    "distance from the centre: luminance by log(1 + √f), labels in 1/sr; dot: light, grey dashes: mirror direction; "
    "models that agree: the later one thinner, on top, its marks elsewhere"
)


def draw(axes, direction, size=1.0):
    """Draw the curves of all entries of a direction.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Of the shape `ASPECT`.
    direction : goniosim.report.comparison.entries.Direction
    size : float
        Of letters and marks.
    """
    radius = tone.remap(direction.scaling.highest) * HEADROOM
    _scale(axes, radius, direction.theta_deg, size)
    count = len(direction.entries)
    for number, (entry, look) in enumerate(zip(direction.entries, style.lines(direction.entries), strict=True)):
        if entry.model is None:
            _band(axes, entry)
        _polar(axes, entry, zorder=5 if entry.model is None else 3, markevery=(APART * number / count, APART), **look)


def tolerance(direction, width):
    """Distance in remapped luminance at which two curves look like one, in a panel of a width in inches."""
    return LINE / width * 2.04 * HEADROOM * tone.remap(direction.scaling.highest)


def _band(axes, entry):
    low, high = (tone.remap(np.nan_to_num(entry.f) + sign * panels.BAND_SIGMAS * entry.sigma) for sign in (-1.0, 1.0))
    tilt = np.radians(entry.angle)
    outline = np.concatenate([high, low[::-1]])
    around = np.concatenate([tilt, tilt[::-1]])
    axes.fill(outline * np.sin(around), outline * np.cos(around), color=style.BAND, linewidth=0.0, zorder=2)


def _polar(axes, entry, **look):
    tilt, r = np.radians(entry.angle), tone.remap(entry.f)
    (line,) = axes.plot(r * np.sin(tilt), r * np.cos(tilt), **look)
    line.set_clip_path(axes.patch)
    alone = panels.isolated(r)
    (r, tilt), look = (r[alone], tilt[alone]), {"color": look["color"], "zorder": look["zorder"]}
    axes.plot(r * np.sin(tilt), r * np.cos(tilt), linestyle="", marker=".", markersize=5.0, **look)


def _scale(axes, radius, theta_deg, size):
    """Half circles at round BSDF values, rays every 30 degrees, the light and the direction straight on."""
    axes.set_xlim(-1.02 * radius, 1.02 * radius)
    axes.set_ylim(-0.08 * radius, 1.02 * radius)
    axes.set_aspect("equal")
    axes.set_axis_off()
    for value in tone.axis_ticks(float(np.expm1(radius) ** 2), 0.24 / size)[1:]:
        r = tone.remap(value)
        axes.add_patch(Arc((0, 0), 2 * r, 2 * r, theta1=0, theta2=180, color="0.85", linewidth=0.7, zorder=1))
        axes.text(r, -0.015 * radius, tone.label(value), ha="center", va="top", fontsize=6.5 * size, color="0.45")
    for degrees in range(-90, 91, 30):
        t = np.radians(degrees)
        axes.plot([0, radius * np.sin(t)], [0, radius * np.cos(t)], color="0.9", linewidth=0.7, zorder=1)
    t = np.radians(theta_deg)
    axes.plot([0, radius * np.sin(t)], [0, radius * np.cos(t)], zorder=1, **panels.STRAIGHT_ON)
    axes.plot(
        [-radius * np.sin(t)],
        [radius * np.cos(t)],
        marker="o",
        markersize=6 * size,
        clip_on=False,
        zorder=6,
        **panels.LIGHT_STYLE,
    )
