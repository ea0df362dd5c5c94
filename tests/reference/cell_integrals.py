"""Integrals of a flux density over every cell of a slice, by adaptive quadrature.

Independent of goniosim.slices: the cells are described here once more. The
densities are those of `reference.closed_forms`; they must be mirror symmetric
about the plane of incidence, as isotropic materials are.
"""

import math

import numpy as np

RELATIVE_TOLERANCE = 1e-7
MAX_CUTS = 60
# Boxes are not halved: a jump near the middle would look alike to the nodes of a box and of its halves, as if it stood
# in the middle. No jump looks alike to a box and to parts of these sizes.
_CUT = 0.38
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


def integrate_cells(density, theta_deg, rows=90, columns=360, parametrization="classic", absolute=1e-12):
    """Energy that leaves into each cell of a reflection slice.

    Parameters
    ----------
    density : function
        Flux density per steradian, as in `reference.closed_forms`. Where it jumps at a height, its attribute ``jump``
        tells the cosine there from that of the light: a jump near the edge of a box hides between nodes.
    theta_deg : float
        Polar angle of the light in degrees.
    rows, columns : int
    parametrization : str
        ``classic`` or ``half``.
    absolute : float
        Error allowed in a cell where `RELATIVE_TOLERANCE` asks for less.

    Returns
    -------
    ndarray, shape (rows, columns)
    """
    theta_l = math.radians(theta_deg)
    # Both row coordinates run from 0 to pi/2; only one side of the plane of incidence is integrated.
    one_side = (columns + 1) // 2
    row_edge = np.linspace(0.0, 0.5 * math.pi, rows + 1)
    column_edge = np.linspace(0.0, 2.0 * math.pi, columns + 1)[: one_side + 1]
    bottom, left = (grid.ravel() for grid in np.meshgrid(row_edge[:-1], column_edge[:-1], indexing="ij"))
    top, right = (grid.ravel() for grid in np.meshgrid(row_edge[1:], column_edge[1:], indexing="ij"))
    if parametrization == "classic":
        cuts = np.array([left, right])
        integrand = _classic_integrand
    else:
        horizon = [_azimuth_of_horizon(edge, theta_l) for edge in (bottom, top)]
        around = [left, *horizon, *(2.0 * math.pi - edge for edge in horizon), right]
        cuts = np.sort(np.clip(around, left, right), axis=0)
        integrand = _half_integrand

    def rule(boxes, cell):
        return _gauss_legendre(integrand, density, theta_l, boxes, bottom[cell], top[cell])

    # A box is (lower and upper height in the cell, from 0 to 1; lower and upper azimuth).
    starts, ends = cuts[:-1], cuts[1:]
    cell = np.broadcast_to(np.arange(len(left)), starts.shape)[starts < ends]
    starts, ends = starts[starts < ends], ends[starts < ends]
    boxes = np.array([np.zeros_like(starts), np.ones_like(starts), starts, ends])
    if parametrization == "classic" and hasattr(density, "jump"):
        boxes, cell = _cut(boxes, cell, math.acos(min(1.0, density.jump(math.cos(theta_l)))), bottom, top)
    cells = _adaptive(rule, boxes, cell, len(left), absolute).reshape(rows, one_side)
    return np.concatenate([cells, cells[:, : columns - one_side][:, ::-1]], axis=1)


def _cut(boxes, cell, theta, bottom, top):
    """Boxes of classic cells, those that hold the polar angle ``theta`` in two."""
    place = np.clip((theta - bottom[cell]) / (top[cell] - bottom[cell]), 0.0, 1.0)
    low, high = boxes.copy(), boxes.copy()
    low[1] = high[0] = place
    both = np.concatenate([low, high], axis=1)
    tall = both[0] < both[1]
    return both[:, tall], np.tile(cell, 2)[tall]


def _adaptive(rule, boxes, cell, n_cells, absolute):
    """Cut every box in four until its parts agree with the whole; sum over the boxes of each cell."""
    total = np.zeros(n_cells)
    whole = rule(boxes, cell)
    for _ in range(MAX_CUTS):
        parts = _parts(boxes)
        values = rule(parts.reshape(4, -1), np.tile(cell, 4)).reshape(4, -1)
        better = values.sum(axis=0)
        done = np.abs(better - whole) <= np.maximum(absolute, RELATIVE_TOLERANCE * better)
        np.add.at(total, cell[done], better[done])
        if done.all():
            return total
        boxes = parts[:, :, ~done].reshape(4, -1)
        whole = values[:, ~done].ravel()
        cell = np.tile(cell[~done], 4)
    raise ArithmeticError("the cell integrals do not converge")


def _parts(boxes):
    """Four parts of every box, shape (4 edges, 4 parts, boxes)."""
    a0, a1, b0, b1 = boxes
    a, b = a0 + _CUT * (a1 - a0), b0 + _CUT * (b1 - b0)
    parts = [(a0, a, b0, b), (a, a1, b0, b), (a0, a, b, b1), (a, a1, b, b1)]
    return np.array(parts).transpose(1, 0, 2)


def _gauss_legendre(integrand, density, theta_l, boxes, bottom, top):
    """Product rule on boxes within cells that reach from `bottom` to `top` in the row coordinate."""
    a0, a1, b0, b1 = (edge[:, None, None] for edge in boxes)
    height = 0.5 * (a0 + a1) + 0.5 * (a1 - a0) * _NODES[:, None]
    phi = 0.5 * (b0 + b1) + 0.5 * (b1 - b0) * _NODES[None, :]
    value = integrand(density, theta_l, height, phi, bottom[:, None, None], top[:, None, None])
    area = 0.25 * (boxes[1] - boxes[0]) * (boxes[3] - boxes[2])
    return area * np.einsum("nij,i,j->n", value, _WEIGHTS, _WEIGHTS)


def _classic_integrand(density, theta_l, height, phi, bottom, top):
    """Solid angle sin(theta_v) dtheta_v dphi_v."""
    theta = bottom + height * (top - bottom)
    sin_v = np.sin(theta)
    x, y = sin_v * np.cos(phi), sin_v * np.sin(phi)
    return density(math.sin(theta_l), math.cos(theta_l), x, y, np.cos(theta)) * sin_v * (top - bottom)


def _half_integrand(density, theta_l, height, phi, bottom, top):
    """Solid angle of v is 4 l.h sin(theta_h) dtheta_h dphi_h.

    v is above the horizon where theta_h < pi/4 + atan(tan(theta_l) cos(phi_h)) / 2. There the
    cell ends: its height, from 0 to 1, covers only what is above, so that no kink is left.
    """
    sin_l, cos_l = math.sin(theta_l), math.cos(theta_l)
    horizon = 0.25 * math.pi + 0.5 * np.arctan2(sin_l * np.cos(phi), cos_l)
    tall = np.maximum(np.minimum(top, np.sqrt(horizon * (0.5 * math.pi))) - bottom, 0.0)
    u = bottom + height * tall
    theta_h = u * u * (2.0 / math.pi)
    sin_h, cos_h = np.sin(theta_h), np.cos(theta_h)
    cos_d = sin_l * sin_h * np.cos(phi) + cos_l * cos_h
    x = 2.0 * cos_d * sin_h * np.cos(phi) - sin_l
    y = 2.0 * cos_d * sin_h * np.sin(phi)
    z = np.maximum(2.0 * cos_d * cos_h - cos_l, 0.0)
    return density(sin_l, cos_l, x, y, z) * 4.0 * cos_d * sin_h * u * (4.0 / math.pi) * tall


def _azimuth_of_horizon(u, theta_l):
    """phi_h in [0, pi] up to which half vectors of row coordinate `u` belong to v above the horizon."""
    theta_h = u * u * (2.0 / math.pi)
    across = math.sin(theta_l) * np.sin(2.0 * theta_h)
    along = -math.cos(theta_l) * np.cos(2.0 * theta_h)
    return np.arccos(np.clip(along / np.maximum(across, 1e-300), -1.0, 1.0))
