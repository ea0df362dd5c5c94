"""The figure of one incident direction: a row of three panels for each component."""

from .. import text
from ..drawing import bands, inplane, legend, panels, tone, view
from ..drawing.disks import Board
from ..drawing.figure import Figure

PIXELS = 600

# Inches.
WIDTH, HEADER, ROW = 12.0, 1.0, 3.1
TOP_VIEW, BAND_VIEW, BAR, PLANE = 0.1, 2.75, 5.4, 6.75
DISK_HEIGHT, PLANE_WIDTH = 2.34, 5.05

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
    title = f"{result.name},  light at {text.degrees(theta_deg)}°"
    legend.title(figure, title)
    board = Board(figure)
    planes = [
        _row(figure, board, HEADER + ROW * n, result, i, name, numbers) for n, name in enumerate(result.components)
    ]
    planes[-1].set_xlabel("view angle in the plane of incidence [deg], light on the left")
    dirac = any(component.contains_delta for component in result.components.values())
    legend.add(figure, planes, invalid=bool((numbers == view.INVALID).any()), dirac=dirac)
    return figure


def _row(figure, board, top, result, i, name, numbers):
    theta_deg = float(result.theta_deg[i])
    component = result.components[name]
    slices, stderr = component.bsdf[i], component.bsdf_stderr[i]
    height = figure.get_figheight()
    figure.text(0.2 / WIDTH, 1.0 - top / height, TITLES[name], fontsize=10.5, fontweight="bold")
    right = (PLANE + PLANE_WIDTH) / WIDTH
    figure.text(right, 1.0 - top / height, _caption(result, i, name), fontsize=9, color="0.3", ha="right")
    top += 0.12
    dirac = panels.dirac_cell(component, i)
    spot = None if dirac is None else view.centre(result.cells, theta_deg, dirac)
    scaling = panels.without_cell(slices, dirac)

    disk = board.disk(TOP_VIEW, top, DISK_HEIGHT)
    white = tone.white_point(view.pixel_values(scaling, numbers)[numbers >= 0])
    disk.colour(slices, numbers, theta_deg, white, spot)
    disk.below(f"colour, full scale {tone.label(float(f'{white:.2g}'))} /sr; rings at 30° and 60°", fontsize=8.5)

    disk = board.disk(BAND_VIEW, top, DISK_HEIGHT)
    lit = bands.extent(slices, numbers)
    scale = bands.scale(*lit) if lit else None
    disk.bands(slices, numbers, theta_deg, scale, spot)
    disk.below("luminance [1/sr]", fontsize=8.5)
    if scale is not None:
        bands.bar(panels.place(figure, BAR, top + 0.12, 0.14, DISK_HEIGHT - 0.24), scale)

    plane = panels.place(figure, PLANE, top + 0.05, PLANE_WIDTH, DISK_HEIGHT - 0.05)
    angle, f, sigma = inplane.plane_of_incidence(result.cells, i, theta_deg, slices, stderr)
    panels.curves(plane, result.channels, angle, f, sigma, sampled=component.hits is not None)
    _, f, sigma = inplane.plane_of_incidence(result.cells, i, theta_deg, scaling, stderr)
    panels.plane_axes(plane, theta_deg, inplane.highest(f, sigma, panels.BAND_SIGMAS))
    plane.set_ylabel("BSDF [1/sr], by log(1 + √f)")
    return plane


def _caption(result, i, name):
    """Albedo per channel, how noisy a cell is, and whether there is a Dirac part."""
    component = result.components[name]
    value = component.energy.sum(axis=(2, 3))
    groups = text.channel_groups(result.channels, [value[i : i + 1]])
    parts = ["albedo  " + "  ".join(f"{label} {value[i, c]:.3g}" for label, c in groups)]
    energy = component.energy[i].sum()
    if component.hits is not None and energy > 0.0:
        noise = 100.0 * component.stderr[i].sum() / energy
        rays = f"{text.count(result.rays[i])} rays" + (" (partial)" if result.status == "partial" else "")
        parts.append(f"noise of a cell about {noise:.2g} % after {rays}")
    if component.contains_delta:
        parts.append("a part leaves in one direction")
    return "   |   ".join(parts)
