"""Lobes in the plane of incidence, reference and models, as in Figs. 5 to 9 of Bati et al. 2019."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Arc

from .. import text
from ..drawing import inplane, panels, tone
from ..drawing.legend import title
from . import legend, style

# Inches.
WIDTH, HEIGHT, COLUMNS, MARGIN, ROOM = 3.5, 1.95, 4, 0.25, 0.5
REFERENCE = {"color": "black", "linestyle": (0, (4, 2)), "linewidth": 1.3}
# Models that go far beyond the reference leave the picture: it is the reference that sets the scale.
HEADROOM = 1.35


def lobes_figure(comparison, directions):
    """Draw the luminance of the main component in the plane of incidence, one half disk per direction.

    Parameters
    ----------
    comparison : goniosim.compare.material.MaterialComparison
    directions : sequence of int

    Returns
    -------
    matplotlib.figure.Figure
    """
    component = comparison.components[0]
    bsdf, stderr = comparison.reference(component)
    columns = min(COLUMNS, max(len(directions), 2))
    rows = -(-len(directions) // columns)
    width = MARGIN + columns * (WIDTH + MARGIN)
    handles = [Line2D([], [], label="simulation", **REFERENCE)]
    handles += [legend.curve(variant) for variant in comparison.variants]
    top = legend.height_needed(width, len(handles))
    figure = Figure(figsize=(width, top + rows * (HEIGHT + ROOM) + 0.3))
    title(figure, f"{comparison.result.name},  {component} in the plane of incidence")
    legend.place(figure, handles)
    slices = {variant: comparison.bsdf(variant.label, component) for variant in comparison.variants}
    for number, m in enumerate(directions):
        row, column = divmod(number, columns)
        axes = panels.place(
            figure, MARGIN + column * (WIDTH + MARGIN), top + row * (HEIGHT + ROOM) + 0.2, WIDTH, HEIGHT
        )
        _half_disk(axes, comparison, m, bsdf[m], stderr[m], {v: values[m] for v, values in slices.items()})
    figure.text(
        0.5,
        0.12 / figure.get_figheight(),
        "distance from the centre: luminance by log(1 + √f), labels in 1/sr; light on the left",
        ha="center",
        fontsize=8.5,
        color="0.3",
    )
    return figure


def _half_disk(axes, comparison, m, bsdf, stderr, slices):
    theta_deg = float(comparison.result.theta_deg[m])
    cells = comparison.result.cells
    angle, f, sigma = _curve(cells, m, theta_deg, bsdf, stderr)
    radius = tone.remap(inplane.highest(f, sigma, panels.BAND_SIGMAS) or 1.0) * HEADROOM
    _scale(axes, radius, theta_deg)
    for variant, values in slices.items():
        model_angle, model, _ = _curve(cells, m, theta_deg, values, np.zeros_like(values))
        _polar(
            axes,
            model_angle,
            model[:, 0],
            color=style.colour(variant),
            linewidth=1.2,
            linestyle=style.line_style(variant),
            zorder=3,
        )
    low, high = (tone.remap(f[:, 0] + sign * panels.BAND_SIGMAS * sigma[:, 0]) for sign in (-1.0, 1.0))
    tilt = np.radians(angle)
    outline = np.concatenate([high, low[::-1]])
    around = np.concatenate([tilt, tilt[::-1]])
    axes.fill(outline * np.sin(around), outline * np.cos(around), color="0.75", linewidth=0.0, zorder=2)
    _polar(axes, angle, f[:, 0], zorder=5, **REFERENCE)
    axes.set_title(f"{text.degrees(theta_deg)}°", fontsize=10, pad=3, loc="left")


def _curve(cells, m, theta_deg, slices, stderr):
    """Luminance in the plane; the errors of the channels, which share their paths, add up."""
    weights = tone.LUMINANCE if len(slices) == 3 else np.full(len(slices), 1.0 / len(slices))
    values, sigma = (np.tensordot(weights, each, axes=1)[None] for each in (slices, stderr))
    return inplane.plane_of_incidence(cells, m, theta_deg, values, sigma)


def _polar(axes, angle, f, **look):
    tilt, r = np.radians(angle), tone.remap(f)
    (line,) = axes.plot(r * np.sin(tilt), r * np.cos(tilt), **look)
    line.set_clip_path(axes.patch)


def _scale(axes, radius, theta_deg):
    """Half circles at round BSDF values, rays every 30 degrees, the light and the direction straight on."""
    axes.set_xlim(-1.02 * radius, 1.02 * radius)
    axes.set_ylim(-0.08 * radius, 1.02 * radius)
    axes.set_aspect("equal")
    axes.set_axis_off()
    for value in tone.axis_ticks(float(np.expm1(radius) ** 2), 0.24)[1:]:
        r = tone.remap(value)
        axes.add_patch(Arc((0, 0), 2 * r, 2 * r, theta1=0, theta2=180, color="0.85", linewidth=0.7, zorder=1))
        axes.text(r, -0.015 * radius, tone.label(value), ha="center", va="top", fontsize=6.5, color="0.45")
    for degrees in range(-90, 91, 30):
        t = np.radians(degrees)
        axes.plot([0, radius * np.sin(t)], [0, radius * np.cos(t)], color="0.9", linewidth=0.7, zorder=1)
    t = np.radians(theta_deg)
    axes.plot([0, radius * np.sin(t)], [0, radius * np.cos(t)], zorder=1, **panels.STRAIGHT_ON)
    axes.plot(
        [-radius * np.sin(t)],
        [radius * np.cos(t)],
        marker="o",
        markersize=6,
        clip_on=False,
        zorder=6,
        **panels.LIGHT_STYLE,
    )
