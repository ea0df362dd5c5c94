"""Compiled parts of the integration: view directions with weights, and weighted sums over cells."""

import math

from .._jit import kernel
from ..slices import CLASSIC, view_direction


@kernel
def fill_subcells(code, light, numbers, half_columns, n, row, column, row_integral, column_integral, x, y, z, weight):
    """View directions at the centres of all sub-cells of some cells, and projected solid angles.

    ``numbers`` are those of `goniosim.compare.grid.Grid.numbers`; each cell fills n * n consecutive
    entries of ``x``, ``y``, ``z`` and ``weight``.
    """
    lx = light[0]
    lz = light[2]
    at = 0
    for k in range(numbers.shape[0]):
        first_row = numbers[k] // half_columns * n
        first_column = numbers[k] % half_columns * n
        for i in range(first_row, first_row + n):
            sine = row[i, 0]
            cosine = row[i, 1]
            a = row_integral[i, 0]
            b = row_integral[i, 1]
            c = row_integral[i, 2]
            for j in range(first_column, first_column + n):
                hx = sine * column[j, 1]
                hy = sine * column[j, 0]
                twice = 2.0 * (lx * hx + lz * cosine)
                x[at] = hx if code == CLASSIC else twice * hx - lx
                y[at] = hy if code == CLASSIC else twice * hy
                z[at] = cosine if code == CLASSIC else twice * cosine - lz
                weight[at] = a * column_integral[j, 0] + b * column_integral[j, 1] + c * column_integral[j, 2]
                at += 1


@kernel
def fill_rectangles(code, light, rectangles, nodes, weights, x, y, z, weight):
    """View directions at Gauss-Legendre nodes of rectangles (u, phi, widths), and cos(theta_v) d omega_v."""
    n = nodes.shape[0]
    at = 0
    for k in range(rectangles.shape[0]):
        u, phi, d_u, d_phi = rectangles[k]
        for i in range(n):
            for j in range(n):
                vx, vy, vz, jacobian = view_direction(
                    code, u + d_u * nodes[i], phi + d_phi * nodes[j], light[0], light[1], light[2]
                )
                x[at] = vx
                y[at] = vy
                z[at] = max(vz, 1e-12)
                weight[at] = weights[i] * weights[j] * d_u * d_phi * jacobian * max(vz, 0.0)
                at += 1


@kernel
def sum_cells(values, weight, per_cell, energy, spread):
    """Weighted sums over ``per_cell`` consecutive entries.

    Parameters
    ----------
    values : ndarray, shape (channels, cells * per_cell)
    weight : ndarray, shape (cells * per_cell,)
    energy : ndarray, shape (channels, cells)
        Receives the sums.
    spread : ndarray, shape (cells,)
        Receives the largest of all channels of (highest - lowest value) / mean value; 0 in the dark.
    """
    for k in range(spread.shape[0]):
        spread[k] = 0.0
    for c in range(values.shape[0]):
        for k in range(spread.shape[0]):
            total = 0.0
            plain = 0.0
            lowest = math.inf
            highest = 0.0
            for i in range(k * per_cell, (k + 1) * per_cell):
                value = values[c, i]
                total += weight[i] * value
                plain += value
                lowest = min(lowest, value)
                highest = max(highest, value)
            energy[c, k] = total
            if plain > 0.0:
                spread[k] = max(spread[k], (highest - lowest) * per_cell / plain)
