"""Integrals over the part above the horizon of the cells of half slices.

A cell reaches from one angle of the half vector to another, and from one azimuth to another. For each azimuth the
horizon ends it at theta_h = pi / 4 + atan(tan(theta_l) cos(phi_h)) / 2. Both sums are by Gauss's rule, that over
theta_h inside that over phi_h, which is cut where an edge of the row meets the horizon.
"""

import math
from collections.abc import Callable

import numpy as np

_IN_THETA, _IN_PHI = 12, 20
# Of grazing light the horizon turns within some cos(theta_l) of these azimuths.
_GRADED = 3.0 ** -np.arange(12.0)


def integrals(
    rows: int, columns: int, theta_deg: float, densities: Callable[[np.ndarray], np.ndarray], count: int
) -> np.ndarray:
    """Integrate functions of the height of the view over cells.

    Parameters
    ----------
    rows, columns : int
    theta_deg : float
        Of the light.
    densities : callable
        Takes cosines of theta_v, an array, and returns values per steradian with another axis in front.
    count : int
        How many these are.

    Returns
    -------
    ndarray, shape (count, rows, columns)
    """
    sine, cosine = math.sin(math.radians(theta_deg)), math.sin(math.radians(90.0 - theta_deg))
    edges = (0.5 * math.pi) * np.linspace(0.0, 1.0, rows + 1) ** 2
    found = np.empty((count, rows, columns))
    for row, (low, high) in enumerate(zip(edges[:-1], edges[1:], strict=True)):
        starts, ends, column = _azimuths(low, high, columns, sine / cosine)
        phi, d_phi = _gauss(starts, ends, _IN_PHI)
        ends = 0.25 * math.pi + 0.5 * np.arctan2(sine * np.cos(phi), cosine)
        theta, d_theta = _gauss(np.full_like(phi, low), np.clip(ends, low, high), _IN_THETA)
        along = sine * np.sin(theta) * np.cos(phi)[..., None] + cosine * np.cos(theta)
        height = np.clip(2.0 * along * np.cos(theta) - cosine, 0.0, 1.0)
        weight = 4.0 * along * np.sin(theta) * d_theta * d_phi[..., None]
        sums = np.sum(densities(height) * weight, axis=(-2, -1))
        found[:, row] = [np.bincount(column, each, columns) for each in sums]
    return found


def _azimuths(low: float, high: float, columns: int, tangent: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intervals of azimuths in which nothing has a kink, and the columns that they belong to."""
    grid = np.linspace(0.0, 2.0 * math.pi, columns + 1)
    cuts = [-1.0 / (math.tan(2.0 * t) * max(tangent, 1e-300)) for t in (low, high) if 0.0 < t < 0.5 * math.pi]
    kinks = [math.acos(cut) for cut in cuts if abs(cut) < 1.0]
    kinks += [0.5 * math.pi + sign * each for each in _GRADED for sign in (-1.0, 1.0)]
    edges = np.unique(np.concatenate([grid, kinks, 2.0 * math.pi - np.array(kinks)]))
    edges = edges[(edges >= 0.0) & (edges <= grid[-1])]
    middle = 0.5 * (edges[:-1] + edges[1:])
    return edges[:-1], edges[1:], np.searchsorted(grid, middle) - 1


def _gauss(start: np.ndarray, end: np.ndarray, nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of intervals, on another axis; square roots at their ends become smooth."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    x = 0.5 * (x + 1.0)
    width = (end - start)[..., None]
    return start[..., None] + width * (x * x * (3.0 - 2.0 * x)), width * (3.0 * w * x * (1.0 - x))
