"""Integrals over the cells of a slice of a flux density with a kink where the facet sees the light at a given cosine.

For facets beyond the critical angle of a rarer medium, say: there a reflectance rises with infinite slope. Nothing here
uses goniosim. Both slices meet the kink l.h = c, and the half slice the horizon, on curves

    sin(theta_l) sin(t) cos(phi) + cos(theta_l) cos(t) = C

with C = 2 c^2 - 1 and t = theta_v (classic), C = c and t = theta_h (half), and C = 0, t = 2 theta_h (horizon). So all
points where they cross the edges of cells are known. Between them, panels are mapped by sin^2, under which roots at
both ends become smooth, and Gauss-Legendre rules converge as fast as for smooth integrands.
"""

import math

import numpy as np

# Panels at a time, so that memory stays bounded.
_BLOCK = 2000


def integrate_kinked_cells(density, cosine, theta_deg, rows, columns, parametrization="classic", nodes=16):
    """Energy that leaves into each cell of a reflection slice.

    Parameters
    ----------
    density : function
        Flux density per steradian, as in `reference.closed_forms`.
    cosine : float
        l.h at the kink.
    theta_deg : float
        Polar angle of the light in degrees.
    rows, columns : int
        ``columns`` is even.
    parametrization : str
        ``classic`` or ``half``.
    nodes : int
        Of the rule along each side of a panel.

    Returns
    -------
    ndarray, shape (rows, columns)
    """
    light = math.radians(theta_deg)
    half = parametrization == "half"
    level = cosine if half else 2.0 * cosine**2 - 1.0
    row_edge = np.linspace(0.0, 0.5 * math.pi, rows + 1)
    column_edge = np.linspace(0.0, 2.0 * math.pi, columns + 1)[: columns // 2 + 1]
    bottom, left = (grid.ravel() for grid in np.meshgrid(row_edge[:-1], column_edge[:-1], indexing="ij"))
    top, right = (grid.ravel() for grid in np.meshgrid(row_edge[1:], column_edge[1:], indexing="ij"))

    breaks = [bottom, top]
    for phi in (left, right, 0.0, math.pi):
        breaks += [_to_row(t, half) for t in _tilts(light, level, phi)]
        if half:
            breaks.append(_to_row(0.5 * _tilts(light, 0.0, phi)[1], half))
    if half:
        # v = 2 c h - l lies in the horizon
        breaks.append(_to_row(math.acos(min(1.0, math.cos(light) / (2.0 * cosine))), half))
    breaks = np.sort([np.clip(np.nan_to_num(each, nan=0.0), bottom, top) for each in breaks], axis=0)
    panel, cell = np.nonzero(np.diff(breaks, axis=0) > 1e-14)
    low, high = breaks[panel, cell], breaks[panel + 1, cell]

    share, weight = _graded(nodes)
    total = np.zeros(len(bottom))
    for first in range(0, len(cell), _BLOCK):
        part = slice(first, first + _BLOCK)
        own = cell[part]
        u = low[part, None] + (high - low)[part, None] * share
        du = (high - low)[part, None] * weight
        start, end = (np.broadcast_to(edge[own, None], u.shape) for edge in (left, right))
        if half:
            end = np.clip(_azimuth(light, 0.0, 2.0 * _to_tilt(u)), start, end)
        kink = np.clip(_azimuth(light, level, _to_tilt(u) if half else u), start, end)
        for a, b in ((start, kink), (kink, end)):
            phi = a[..., None] + (b - a)[..., None] * share
            value = _integrand(density, light, u[..., None], phi, half)
            np.add.at(total, own, np.einsum("pij,pi,pij->p", value, du, (b - a)[..., None] * weight))
    one_side = total.reshape(rows, columns // 2)
    return np.concatenate([one_side, one_side[:, ::-1]], axis=1)


def _integrand(density, light, u, phi, half):
    """Of the row coordinate and the azimuth, with d omega = sin(t) dt dphi and d omega_v = 4 l.h d omega_h."""
    sin_l, cos_l = math.sin(light), math.cos(light)
    t = _to_tilt(u) if half else u
    x, y, z = np.sin(t) * np.cos(phi), np.sin(t) * np.sin(phi), np.cos(t)
    jacobian = np.sin(t)
    if half:
        facet = sin_l * x + cos_l * z
        jacobian = jacobian * 4.0 * facet * 4.0 * u / math.pi
        x, y, z = 2.0 * facet * x - sin_l, 2.0 * facet * y, np.maximum(2.0 * facet * z - cos_l, 0.0)
    return density(sin_l, cos_l, x, y, z) * jacobian


def _to_tilt(u):
    return u * u * (2.0 / math.pi)


def _to_row(t, half):
    return np.sqrt(np.maximum(t, 0.0) * (0.5 * math.pi)) if half else np.asarray(t)


def _tilts(light, level, phi):
    """Both t at which the curve has the azimuth ``phi``; NaN where it does not reach there."""
    across, along = math.sin(light) * np.cos(phi), math.cos(light)
    with np.errstate(invalid="ignore"):
        away = np.arccos(level / np.hypot(across, along))
    return np.arctan2(across, along) - away, np.arctan2(across, along) + away


def _azimuth(light, level, t):
    """Azimuth in [0, pi] of the curve; 0 or pi where all of the circle lies on one side of it."""
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = (level - math.cos(light) * np.cos(t)) / (math.sin(light) * np.sin(t))
    return np.arccos(np.clip(np.nan_to_num(cosine, nan=1.0), -1.0, 1.0))


def _graded(n):
    """Nodes and weights on [0, 1], crowded at both ends."""
    x, w = np.polynomial.legendre.leggauss(n)
    s = 0.25 * math.pi * (1.0 + x)
    return np.sin(s) ** 2, 0.25 * math.pi * w * np.sin(2.0 * s)
