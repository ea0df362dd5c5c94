"""The figure of one incident direction: a row of three panels for each component."""

import numpy as np

from ...scene.quantity import percent
from .. import text
from ..drawing import bands, inplane, legend, letters, panels, tone, view, zoom
from ..drawing.disks import Board
from ..drawing.figure import Figure

PIXELS = 600

# Inches.
WIDTH, HEADER, ROW = 12.0, 1.0, 3.1
TOP_VIEW, BAND_VIEW, BAR, PLANE = 0.1, 2.75, 5.4, 6.75
DISK_HEIGHT, PLANE_WIDTH, FOOTER = 2.34, 5.05, 0.23
# Beside a closer look, the plot of all angles is narrower.
ZOOM_WIDTH, ZOOM_GAP = 1.75, 0.2
# Between the disks, in the corner that they leave: its middle, its size.
CLOSER, CLOSER_SIZE, CLOSER_PIXELS = 2.9, 0.56, 120
# Channels whose albedos are written out.
MOST_ALBEDOS = 6

TITLES = {
    "reflection/direct": "Reflection, direct",
    "reflection/internal": "Reflection, internal paths",
    "reflection": "Reflection",
    "transmission": "Transmission, mirrored to the upper side",
}


def direction_figure(result, i):
    """Draw all components of one incident direction.

    Parameters
    ----------
    result : goniosim.result.Result
    i : int
        Index of the direction.

    Returns
    -------
    matplotlib.figure.Figure
    """
    theta_deg = float(result.theta_deg[i])
    numbers = view.disk(result.cells, i, theta_deg, PIXELS)
    figure = Figure(figsize=(WIDTH, HEADER + ROW * len(result.components)))
    title = f"{result.name},  light at {text.angles(result.theta_deg)[i]}°"
    legend.title(figure, title)
    board = Board(figure)
    planes, enlarged = zip(
        *[_row(figure, board, HEADER + ROW * n, result, i, name, numbers) for n, name in enumerate(result.components)],
        strict=True,
    )
    words = "view angle in the plane of incidence [deg], light on the left"
    look = {"fontsize": 9, "color": "0.2", "ha": "center"}
    figure.text((PLANE + 0.5 * PLANE_WIDTH) / WIDTH, FOOTER / figure.get_figheight(), words, **look)
    dirac = any(component.contains_delta for component in result.components.values())
    unseen = any(panels.unseen_cells([each], result.cells, i) is not None for each in result.components.values())
    legend.add(
        figure,
        planes,
        invalid=bool((numbers == view.INVALID).any()),
        dirac=dirac,
        unseen=unseen,
        enlarged=any(enlarged),
    )
    return figure


def _row(figure, board, top, result, i, name, numbers):
    theta_deg = float(result.theta_deg[i])
    component = result.components[name]
    slices = component.bsdf[i]
    height = figure.get_figheight()
    figure.text(0.2 / WIDTH, 1.0 - top / height, TITLES[name], fontsize=10.5, fontweight="bold")
    right = PLANE + PLANE_WIDTH
    words = _caption(result, i, name)
    room = right - 0.5 - letters.width(TITLES[name], 10.5, bold=True)
    look = {"fontsize": letters.fitting(words, 9, room), "color": "0.3", "ha": "right", "parse_math": False}
    figure.text(right / WIDTH, 1.0 - top / height, words, **look)
    top += 0.12
    dirac = panels.dirac_cell(component, i)
    spot = None if dirac is None else view.centre(result.cells, theta_deg, dirac)
    scaling = panels.without_cell(slices, dirac)
    unseen = panels.unseen_cells([component], result.cells, i)

    disk = board.disk(TOP_VIEW, top, DISK_HEIGHT)
    white = tone.white_point(view.pixel_values(scaling, numbers)[numbers >= 0])
    disk.colour(slices, numbers, theta_deg, white, spot, unseen)
    disk.below(f"colour, full scale {tone.label(float(f'{white:.2g}'))} /sr; rings at 30° and 60°", fontsize=8.5)

    curve, clear = (
        inplane.plane_of_incidence(result.cells, i, theta_deg, f, component.bsdf_stderr[i]) for f in (slices, scaling)
    )
    # What leaves in one exact direction and nothing else has a ring, and no shape to be seen.
    shown = None if dirac is not None and scaling is slices else zoom.of_channels(*clear)
    near = None if shown is None else _magnified(result.cells, i, theta_deg, shown)

    disk = board.disk(BAND_VIEW, top, DISK_HEIGHT)
    scale = _scale(slices, scaling, numbers, near)
    disk.bands(slices, numbers, theta_deg, scale, spot, unseen)
    disk.below("luminance [1/sr]", fontsize=8.5)
    if scale is not None:
        bands.bar(panels.place(figure, BAR, top + 0.12, 0.14, DISK_HEIGHT - 0.24), scale)

    if near is not None:
        words = f"± {_reach(shown):.2g}°"
        board.closer(CLOSER, top + 0.05, CLOSER_SIZE, slices, near, scale, unseen, words)
    highest = inplane.highest(*clear[1:], panels.BAND_SIGMAS)
    plane = _curves(figure, top + 0.05, result.channels, theta_deg, component.sampled, curve, highest, shown)
    return plane, shown is not None


def _reach(shown):
    return 0.5 * (shown[1] - shown[0])


def _magnified(cells, i, theta_deg, shown):
    return view.magnified(cells, i, theta_deg, 0.5 * sum(shown), _reach(shown), CLOSER_PIXELS)


def _scale(slices, scaling, numbers, near):
    """Bands for the whole slice; with a closer look they reach up to its peak, of which the disk has few pixels."""
    lit = bands.extent(slices, numbers)
    if lit is None:
        return None
    peak = 0.0 if near is None else np.quantile(tone.luminance(view.pixel_values(scaling, near)), 0.98)
    return bands.scale(lit[0], max(lit[1], float(peak)))


def _curves(figure, top, channels, theta_deg, sampled, curve, highest, shown):
    """The plane of incidence, and beside it a closer look at a narrow lobe."""
    height = DISK_HEIGHT - 0.05
    width = PLANE_WIDTH - (ZOOM_WIDTH + ZOOM_GAP if shown else 0.0)
    plane = panels.place(figure, PLANE, top, width, height)
    panels.curves(plane, channels, *curve, sampled=sampled)
    panels.plane_axes(plane, theta_deg, highest)
    panels.note_coinciding(plane, channels, *curve, highest or 1.0)
    plane.set_ylabel("BSDF [1/sr], by log(1 + √f)")
    if shown:
        zoom.mark(plane, shown)
        near = panels.place(figure, PLANE + width + ZOOM_GAP, top, ZOOM_WIDTH, height)
        panels.curves(near, channels, *curve, sampled=sampled)
        near.set_ylim(plane.get_ylim())
        near.set_yticks(plane.get_yticks(), [])
        zoom.furnish(near, shown, theta_deg)
    return plane


def _caption(result, i, name):
    """Albedo per channel, how noisy a cell is, and whether there is a Dirac part."""
    component = result.components[name]
    value = component.energy.sum(axis=(2, 3))
    groups = text.channel_groups(result.channels, [value[i : i + 1]])
    if len(groups) > MOST_ALBEDOS:
        parts = [f"albedo {value[i].min():.3g} to {value[i].max():.3g} in {len(result.channels)} channels"]
    else:
        parts = ["albedo  " + "  ".join(f"{label} {value[i, c]:.3g}" for label, c in groups)]
    energy = component.energy[i].sum()
    if component.sampled and energy > 0.0:
        noise = component.stderr[i].sum() / energy
        rays = f"{text.count(result.rays[i])} rays" + (" (partial)" if result.status == "partial" else "")
        parts.append(f"noise of a cell about {percent(noise)} after {rays}")
    if component.contains_delta:
        parts.append("a part leaves in one direction")
    return "   |   ".join(parts)
