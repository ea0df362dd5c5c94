"""The BSDF of one interface between all nodes: its cosine coefficients in azimuth, as matrices over polar angles."""

import math

import numpy as np

from ..._jit import kernel, stage
from ...optics.elementary import sincos_turns
from ...optics.fresnel import dielectric_transmittance, fresnel_conductor, fresnel_dielectric
from ...optics.microfacet import microfacet_reflection, microfacet_transmission
from .azimuths import end_weights, to_coefficients

# What happens to light from inside: it leaves, or is reflected by a conductor or by a dielectric.
TRANSMISSION, CONDUCTOR, INTERNAL = range(3)

# Node at grazing angles, so that nothing is divided by zero.
_LEAST_COSINE = 1e-9
# Two directions opposite in the horizon have no half vector.
_LEAST_FACET = 1e-5
# Rows of cells, or of nodes, that are made at a time.
BLOCK = 15


def coefficients(event, alpha, eta, kappa, rows, matrix, found):
    """Coefficients of a kernel, for rows that are weighted sums over the nodes of the outgoing polar angle.

    Parameters
    ----------
    event : int
    alpha, eta, kappa : float
        Width; index inside over outside of a dielectric, or the relative index of a conductor.
    rows : goniosim.engine.operators.cells.Rows
    matrix : ndarray
        As `azimuths.cosines` yields it.
    found : ndarray, shape (azimuths, number of rows, incoming polar angles)
        Overwritten; nodes are equally far apart, from 0 to 180 and from 0 to 90 degrees.
    """
    azimuths, _, polar = found.shape
    matrix = matrix * end_weights(azimuths - 1)
    table = np.empty(azimuths * rows.nodes_of(BLOCK) * polar)
    for first in range(0, len(rows), BLOCK):
        count = min(BLOCK, len(rows) - first)
        shape = (azimuths, rows.nodes_of(count), polar)
        # Contiguous, the last and smaller one too: the kernel is compiled once.
        some = table[: math.prod(shape)].reshape(shape)
        tabulate(event, alpha, eta, kappa, rows.nodes, rows.first_node(first), some)
        block = rows.combine(first, some)
        answer = np.empty((len(block), count * polar))
        to_coefficients(matrix, block.reshape(len(block), -1), answer)
        found[:, first : first + count] = answer.reshape(len(block), count, -1)


@kernel
def tabulate(event, alpha, eta, kappa, outgoing, first, table):
    """Fill ``table[azimuth, outgoing - first, incoming]`` with BSDF values; 90 degrees have ``outgoing`` distances."""
    nodes = table.shape[2] - 1
    sines = np.empty(nodes + 1)
    heights = np.empty(nodes + 1)
    for b in range(nodes + 1):
        sines[b], heights[b] = _polar(b, nodes)
    for i in range(table.shape[1]):
        vs, vz = _polar(first + i, outgoing)
        for j in range(table.shape[0]):
            s, c = sincos_turns(0.5 * j / (table.shape[0] - 1))
            row = table[j, i]
            if event == TRANSMISSION:
                _transmission(sines, heights, vs * c, vs * s, vz, alpha, eta, row)
            elif event == CONDUCTOR:
                _conductor(sines, heights, vs * c, vs * s, vz, alpha, eta, kappa, row)
            else:
                _internal(sines, heights, vs * c, vs * s, vz, alpha, eta, row)


@stage
def _polar(number, nodes):
    angle = 0.5 * math.pi * number / nodes
    return math.sin(angle), max(math.cos(angle), _LEAST_COSINE)


@stage
def _transmission(sines, heights, vx, vy, vz, alpha, eta, row):
    for b in range(row.shape[0]):
        value, cosine = microfacet_transmission(sines[b], 0.0, heights[b], vx, vy, vz, alpha, eta)
        row[b] = value * dielectric_transmittance(cosine, eta)


@stage
def _conductor(sines, heights, vx, vy, vz, alpha, eta, kappa, row):
    for b in range(row.shape[0]):
        value, cosine = microfacet_reflection(sines[b], 0.0, heights[b], vx, vy, vz, alpha)
        row[b] = value * fresnel_conductor(cosine, eta, kappa) if cosine > _LEAST_FACET else 0.0


@stage
def _internal(sines, heights, vx, vy, vz, alpha, eta, row):
    for b in range(row.shape[0]):
        value, cosine = microfacet_reflection(sines[b], 0.0, heights[b], vx, vy, vz, alpha)
        reflectance, _ = fresnel_dielectric(cosine, 1.0 / eta)
        row[b] = value * reflectance if cosine > _LEAST_FACET else 0.0
