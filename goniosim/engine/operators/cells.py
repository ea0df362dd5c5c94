"""Rows of a kernel: the nodes themselves, or the rows of classic cells by Simpson's rule over the nodes in each."""

import math

import numpy as np

from ...slices.grid import HALF_PI


def simpson(intervals):
    """Weights of Simpson's rule over an even number of intervals; they sum to 1."""
    weights = np.full(intervals + 1, 2.0)
    weights[1::2] = 4.0
    weights[[0, -1]] = 1.0
    return weights / (3.0 * intervals)


def fits(plan, nodes):
    """Whether the cells of a plan are classic ones with an even number of nodes' distances in each direction."""
    return (
        plan.parametrization_name == "classic"
        and plan.columns % 2 == 0
        and nodes % plan.rows == 0
        and nodes // plan.rows % 2 == 0
        and 4 * nodes % plan.columns == 0
        and 4 * nodes // plan.columns % 2 == 0
    )


class Nodes:
    """Every node is a row."""

    def __init__(self, nodes):
        self.nodes = nodes

    def __len__(self):
        return self.nodes + 1

    def nodes_of(self, rows):
        """Nodes that so many rows take."""
        return rows

    def first_node(self, row):
        """The first of them."""
        return row

    def combine(self, first, table):
        """Rows of the nodes ``table[azimuth, node, incoming]``, of which the first is that of row ``first``."""
        return np.ascontiguousarray(table)


class CellRows:
    """Rows of classic cells: energies, less what `azimuth_factor` adds."""

    def __init__(self, plan, nodes):
        self.nodes = nodes
        self.rows = plan.rows
        self.per_row = nodes // plan.rows
        angle = np.linspace(0.0, HALF_PI, nodes + 1)
        # The integral over the row of cos(theta) sin(theta) d theta times what is integrated.
        self.measure = np.cos(angle) * np.sin(angle)
        self.weights = simpson(self.per_row) * (HALF_PI / plan.rows)

    def __len__(self):
        return self.rows

    def nodes_of(self, rows):
        """Nodes that so many rows take."""
        return rows * self.per_row + 1

    def first_node(self, row):
        """The first of them."""
        return row * self.per_row

    def combine(self, first, table):
        """Rows of the nodes ``table[azimuth, node, incoming]``, of which the first is that of row ``first``."""
        count = (table.shape[1] - 1) // self.per_row
        start = self.first_node(first)
        found = np.zeros((table.shape[0], count, table.shape[2]))
        for k, weight in enumerate(self.weights):
            measure = weight * self.measure[start + k : start + k + count * self.per_row : self.per_row]
            found += measure[:count, None] * table[:, k : k + count * self.per_row : self.per_row][:, :count]
        return found


def column_matrix(plan, nodes, at_azimuths):
    """The matrix from coefficients to the folded columns of classic cells: integrals over each by Simpson's rule."""
    per_column = 4 * nodes // plan.columns
    centres = (np.arange(plan.width) + 0.5) * per_column
    offsets = np.arange(per_column + 1) - 0.5 * per_column
    # cos(m (phi + d)) and its mirror image add up to 2 cos(m phi) cos(m d).
    turns = np.multiply.outer(np.arange(2 * nodes + 1), offsets)
    factor = np.cos(math.pi / (2 * nodes) * turns) @ simpson(per_column)
    return at_azimuths(2 * nodes, centres) * (factor * (2.0 * math.pi / plan.columns))
