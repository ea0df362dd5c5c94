"""From the directions that an eye sees to the cells of a slice, and back.

In every picture the light comes from the left. Transmitted directions are mirrored to the upper
side, as they are in the file.
"""

import numpy as np

from ...slices import PARAMETRIZATIONS

OUTSIDE = -1
INVALID = -2


def cell_numbers(cells, direction, theta_deg, view):
    """Find the cells that hold directions.

    Parameters
    ----------
    cells : goniosim.result.Cells
    direction : int
        Which of the incident directions.
    theta_deg : float
        Its angle; the light stands at phi = 0.
    view : ndarray, shape (..., 3)
        Unit vectors; those below the horizon are outside.

    Returns
    -------
    ndarray of int64, shape (...)
        ``row * K + column``, `OUTSIDE` or `INVALID` (a cell that is not wholly above the horizon).
    """
    u, psi = _parametrization(cells).coordinates(view, light_direction(theta_deg))
    coordinate, azimuth = np.degrees(u), np.degrees(np.pi - psi) % 360.0
    row = index(cells.row_edges, coordinate)
    column = index(cells.column_edges, azimuth)
    number = row * (len(cells.column_edges) - 1) + column
    number = np.where(cells.valid[direction].ravel()[number], number, INVALID)
    return np.where(view[..., 2] < 0.0, OUTSIDE, number)


def disk(cells, direction, theta_deg, pixels):
    """Cells seen in an orthographic view from above, as a square of pixels.

    Parameters
    ----------
    cells : goniosim.result.Cells
    direction : int
    theta_deg : float
    pixels : int
        Pixels along each side of the square around the unit disk.

    Returns
    -------
    ndarray of int64, shape (pixels, pixels)
        As `cell_numbers`, top row first.
    """
    centres = (np.arange(pixels) + 0.5) * (2.0 / pixels) - 1.0
    right, up = np.meshgrid(centres, -centres)
    height_squared = 1.0 - right**2 - up**2
    height = np.where(height_squared > 0.0, np.sqrt(np.abs(height_squared)), -1.0)
    # Turned by half a circle, for the light stands on the left.
    return cell_numbers(cells, direction, theta_deg, np.stack([-right, -up, height], axis=-1))


def magnified(cells, direction, theta_deg, angle_deg, reach_deg, pixels):
    """Cells round a direction in the plane of incidence, seen from there, as a square of pixels.

    Parameters
    ----------
    cells : goniosim.result.Cells
    direction : int
    theta_deg : float
    angle_deg : float
        Signed angle of the middle from the normal, positive on the side of the mirror direction.
    reach_deg : float
        From the middle to each side of the square.
    pixels : int
        Along each side.

    Returns
    -------
    ndarray of int64, shape (pixels, pixels)
        As `disk`: the plane of incidence lies level, the light on the left.
    """
    offsets = np.tan(np.radians(reach_deg)) * ((np.arange(pixels) + 0.5) * (2.0 / pixels) - 1.0)
    right, up = np.meshgrid(offsets, -offsets)
    sine, cosine = np.sin(np.radians(angle_deg)), np.cos(np.radians(angle_deg))
    seen = np.stack([-sine - cosine * right, -up, cosine - sine * right], axis=-1)
    return cell_numbers(cells, direction, theta_deg, seen / np.linalg.norm(seen, axis=-1, keepdims=True))


def pixel_values(slices, numbers):
    """BSDF of every pixel, shape (pixels, pixels, C); zero where there is no valid cell."""
    by_cell = slices.reshape(len(slices), -1).T
    return np.where(numbers[..., None] >= 0, by_cell[np.maximum(numbers, 0)], 0.0)


def centre(cells, theta_deg, number):
    """Direction of the centre of a cell.

    Parameters
    ----------
    cells : goniosim.result.Cells
    theta_deg : float
        Angle of incidence; the light stands at phi = 0.
    number : int

    Returns
    -------
    ndarray, shape (3,)
        Unit vector; below the horizon for some cells of a half slice.
    """
    row, column = divmod(number, len(cells.column_edges) - 1)
    u = np.radians(0.5 * (cells.row_edges[row] + cells.row_edges[row + 1]))
    azimuth = np.radians(0.5 * (cells.column_edges[column] + cells.column_edges[column + 1]))
    return _parametrization(cells).directions(u, azimuth, light_direction(theta_deg))


def in_plane(cells, theta_deg, azimuth_deg):
    """Where the edges of the rows cut the plane of incidence, on the side of an azimuth of 0 or 180 degrees.

    Returns
    -------
    tilt : ndarray, shape (R + 1,)
        From the pole of the parametrization, in degrees.
    angle : ndarray, shape (R + 1,)
        Signed angle from the normal in degrees: negative towards the light.
    """
    module, u = _parametrization(cells), np.radians(cells.row_edges)
    x, _, z = module.directions(u, np.radians(azimuth_deg), light_direction(theta_deg)).T
    return np.degrees(module.tilt(u)), np.degrees(np.arctan2(-x, z))


def light_direction(theta_deg):
    """Unit vector to the light, which stands at phi = 0."""
    theta = np.radians(theta_deg)
    return np.array([np.sin(theta), 0.0, np.cos(theta)])


def index(edges, values):
    """Number of the interval between ``edges`` that holds each of the ``values``."""
    return np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)


def _parametrization(cells):
    return PARAMETRIZATIONS[cells.parametrization][1]
