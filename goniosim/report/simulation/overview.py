"""The overview: all incident directions side by side, what leaves above and what leaves below."""

import numpy as np

from ...result import Component
from .. import text
from ..drawing import directions, disks, inplane, legend, panels, tone, view
from ..drawing.figure import Figure

PIXELS = 400

# Of more directions, some stand for all.
MOST = 9
NARROWEST = 10.5

# Inches.
LEFT, COLUMN, HEADER, ROW = 0.7, 2.15, 1.0, 3.65
FOOTER = 0.25
DISK_WIDTH, PLANE_TOP, PLANE_WIDTH, PLANE_HEIGHT = 1.95, 2.15, 1.72, 1.1

TITLES = {"reflection": "Reflection", "transmission": "Transmission, mirrored to the upper side"}


def overview_figure(result):
    """Draw the sum of the reflected components, and the transmission, for all incident directions.

    Parameters
    ----------
    result : goniosim.result.Result

    Returns
    -------
    matplotlib.figure.Figure
    """
    n = len(result.theta_deg)
    shown = directions.spread(n, MOST)
    sides = [side for side in TITLES if any(name.startswith(side) for name in result.components)]
    width = max(LEFT + COLUMN * len(shown), NARROWEST)
    figure = Figure(figsize=(width, HEADER + ROW * len(sides) + FOOTER))
    legend.title(figure, result.name + (f"  ({len(shown)} of {n} directions)" if len(shown) < n else ""))
    numbers = [view.disk(result.cells, i, float(result.theta_deg[i]), PIXELS) for i in shown]
    board = disks.Board(figure)
    planes = []
    for row, side in enumerate(sides):
        planes += _row(figure, board, HEADER + ROW * row, result, side, shown, numbers)
    legend.caption(
        figure,
        "view angle in the plane of incidence [deg], light on the left; scales by log(1 + √f), one for each direction",
        middle=LEFT + 0.5 * COLUMN * (len(shown) - 1) + 0.5 * PLANE_WIDTH,
    )
    invalid = any(bool((each == view.INVALID).any()) for each in numbers)
    dirac = any(component.contains_delta for component in result.components.values())
    unseen = any(panels.unseen_cells(_on(result, side), result.cells, i) is not None for side in sides for i in shown)
    legend.add(figure, planes, invalid=invalid, dirac=dirac, unseen=unseen)
    return figure


def _row(figure, board, top, result, side, shown, numbers):
    width, height = figure.get_size_inches()
    figure.text(0.2 / width, 1.0 - top / height, TITLES[side], fontsize=10.5, fontweight="bold")
    parts = _on(result, side)
    total = _sum(parts)
    angles = text.angles(result.theta_deg)
    planes = []
    for column, (i, each) in enumerate(zip(shown, numbers, strict=True)):
        left = LEFT + COLUMN * column
        disk = board.disk(left - 0.22, top + 0.3, DISK_WIDTH / disks.ASPECT)
        plane = panels.place(figure, left, top + PLANE_TOP, PLANE_WIDTH, PLANE_HEIGHT)
        _column(disk, plane, result, total, i, each, panels.unseen_cells(parts, result.cells, i))
        disk.above(f"{angles[i]}°", fontsize=10)
        plane.set_xticks([-60, 0, 60])
        plane.tick_params(labelsize=7.5)
        planes.append(plane)
    planes[0].set_ylabel("BSDF [1/sr]")
    return planes


def _column(disk, plane, result, total, i, numbers, unseen):
    theta_deg = float(result.theta_deg[i])
    slices, stderr = total.bsdf[i], total.bsdf_stderr[i]
    dirac = panels.dirac_cell(total, i)
    spot = None if dirac is None else view.centre(result.cells, theta_deg, dirac)
    scaling = panels.without_cell(slices, dirac)
    white = tone.white_point(view.pixel_values(scaling, numbers)[numbers >= 0])
    disk.colour(slices, numbers, theta_deg, white, spot, unseen)
    angle, f, sigma = inplane.plane_of_incidence(result.cells, i, theta_deg, slices, stderr)
    panels.curves(plane, result.channels, angle, f, sigma, sampled=unseen is not None)
    _, *clear = inplane.plane_of_incidence(result.cells, i, theta_deg, scaling, stderr)
    highest = inplane.highest(*clear, panels.BAND_SIGMAS)
    panels.plane_axes(plane, theta_deg, highest, spacing=0.15)
    panels.note_coinciding(plane, result.channels, angle, f, sigma, highest or 1.0, size=7.0)


def _on(result, side):
    return [component for name, component in result.components.items() if name.startswith(side)]


def _sum(components):
    """What leaves on one side in all: the values only."""
    return Component(
        energy=sum(component.energy for component in components),
        stderr=np.sqrt(sum(component.stderr**2 for component in components)),
        bsdf=sum(component.bsdf for component in components),
        bsdf_stderr=np.sqrt(sum(component.bsdf_stderr**2 for component in components)),
        contains_delta=any(component.contains_delta for component in components),
    )
