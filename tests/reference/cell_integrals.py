"""Integrals of a flux density over every cell of a slice, by adaptive quadrature.

Independent of goniosim.slices: the cells are described here once more. The
densities are those of `reference.closed_forms`; they must be mirror symmetric
about the plane of incidence, as isotropic materials are.
"""

import math

import numpy as np

RELATIVE_TOLERANCE = 1e-7
ABSOLUTE_TOLERANCE = 1e-12
MAX_HALVINGS = 40
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


def integrate_cells(density, theta_deg, rows=90, columns=360, parametrization="classic"):
    """Energy that leaves into each cell of a reflection slice.

    Parameters
    ----------
    density : function
        Flux density per steradian, as in `reference.closed_forms`.
    theta_deg : float
        Polar angle of the light in degrees.
    rows, columns : int
    parametrization : str
        ``classic`` or ``half``.

    Returns
    -------
    ndarray, shape (rows, columns)
    """
    theta_l = math.radians(theta_deg)
    integrand = _classic_integrand if parametrization == "classic" else _half_integrand
    # Both row coordinates run from 0 to pi/2; only one side of the plane of incidence is integrated.
    one_side = (columns + 1) // 2
    row_edge = np.linspace(0.0, 0.5 * math.pi, rows + 1)
    column_edge = np.linspace(0.0, 2.0 * math.pi, columns + 1)[: one_side + 1]
    a0, b0 = np.meshgrid(row_edge[:-1], column_edge[:-1], indexing="ij")
    a1, b1 = np.meshgrid(row_edge[1:], column_edge[1:], indexing="ij")
    boxes = np.stack([a0.ravel(), a1.ravel(), b0.ravel(), b1.ravel()])
    cells = _adaptive(lambda box: integrand(density, theta_l, box), boxes).reshape(rows, one_side)
    return np.concatenate([cells, cells[:, : columns - one_side][:, ::-1]], axis=1)


def _adaptive(rule, boxes):
    """Halve every box in both coordinates until the parts agree with the whole."""
    total = np.zeros(boxes.shape[1])
    owner = np.arange(boxes.shape[1])
    whole = rule(boxes)
    for _ in range(MAX_HALVINGS):
        parts = _quarter(boxes)
        values = rule(parts.reshape(4, -1)).reshape(4, -1)
        better = values.sum(axis=0)
        done = np.abs(better - whole) <= np.maximum(ABSOLUTE_TOLERANCE, RELATIVE_TOLERANCE * better)
        np.add.at(total, owner[done], better[done])
        if done.all():
            return total
        boxes = parts[:, :, ~done].reshape(4, -1)
        whole = values[:, ~done].ravel()
        owner = np.tile(owner[~done], 4)
    raise ArithmeticError("the cell integrals do not converge")


def _quarter(boxes):
    """Four quarters of every box, shape (4 edges, 4 quarters, boxes)."""
    a0, a1, b0, b1 = boxes
    a, b = 0.5 * (a0 + a1), 0.5 * (b0 + b1)
    quarters = [(a0, a, b0, b), (a, a1, b0, b), (a0, a, b, b1), (a, a1, b, b1)]
    return np.array(quarters).transpose(1, 0, 2)


def _classic_integrand(density, theta_l, boxes):
    """Gauss-Legendre over (theta_v, phi_v): solid angle sin(theta_v) dtheta dphi."""
    a0, a1, b0, b1 = (edge[:, None, None] for edge in boxes)
    theta = 0.5 * (a0 + a1) + 0.5 * (a1 - a0) * _NODES[:, None]
    phi = 0.5 * (b0 + b1) + 0.5 * (b1 - b0) * _NODES[None, :]
    sin_v = np.sin(theta)
    value = density(
        math.sin(theta_l), math.cos(theta_l), sin_v * np.cos(phi), sin_v * np.sin(phi), np.cos(theta)
    )
    value = value * sin_v
    weight = 0.25 * (boxes[1] - boxes[0]) * (boxes[3] - boxes[2])
    return weight * np.einsum("nij,i,j->n", value, _WEIGHTS, _WEIGHTS)


def _half_integrand(density, theta_l, boxes):
    """Gauss-Legendre over (u, phi_h): solid angle of v is 4 l.h sin(theta_h) dtheta_h dphi_h.

    v rises above the horizon where theta_h < pi/4 + atan(tan(theta_l) cos(phi_h)) / 2, so the
    inner integral stops there and stays smooth.
    """
    a0, a1, b0, b1 = (edge[:, None, None] for edge in boxes)
    phi = 0.5 * (b0 + b1) + 0.5 * (b1 - b0) * _NODES[None, :]
    sin_l, cos_l = math.sin(theta_l), math.cos(theta_l)
    horizon = 0.25 * math.pi + 0.5 * np.arctan2(sin_l * np.cos(phi), cos_l)
    top = np.minimum(a1, np.sqrt(horizon * (0.5 * math.pi)))
    width = np.maximum(top - a0, 0.0)
    u = a0 + 0.5 * width * (1.0 + _NODES[:, None])
    theta_h = u * u * (2.0 / math.pi)
    sin_h, cos_h = np.sin(theta_h), np.cos(theta_h)
    cos_d = sin_l * sin_h * np.cos(phi) + cos_l * cos_h
    x = 2.0 * cos_d * sin_h * np.cos(phi) - sin_l
    y = 2.0 * cos_d * sin_h * np.sin(phi)
    z = np.maximum(2.0 * cos_d * cos_h - cos_l, 0.0)
    jacobian = 4.0 * cos_d * sin_h * u * (4.0 / math.pi)
    value = density(sin_l, cos_l, x, y, z) * jacobian * (0.5 * width)
    return 0.5 * (boxes[3] - boxes[2]) * np.einsum("nij,i,j->n", value, _WEIGHTS, _WEIGHTS)
