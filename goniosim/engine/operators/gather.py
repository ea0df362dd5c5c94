"""Cells from a smooth radiance at the nodes: four points of each cell, if need be through a narrow exit.

The points are a random one and its turns about the cell's centre by quarters: what is linear in the cell cancels.
Through an exit, each point is followed backwards by facets as seen from outside. Their rare tail is drawn apart, as a
difference to the core at the same point: the weights of tail and core are constants, and do not add to the scatter.
"""

import math

import numpy as np

from ..._jit import kernel, stage
from ...optics.elementary import sincos_turns
from ...optics.fresnel import dielectric_transmittance, fresnel_dielectric
from ...optics.ggx import sample_visible_normal, smith_g1
from ...optics.medium import path_length, transmittance
from ...optics.microfacet import microfacet_transmission
from ...optics.random import derive_key, uniform
from ...slices import view_direction, view_row
from ...slices.grid import HALF_PI
from ..lattice import coordinate
from .nodes import interpolate

# Points of a cell, and facets of the tail, which follow from every second of them.
POINTS, TAILS = 4, 2
# Which child of a replicate's key draws the points.
CELLS = 2
# Share of the facets that is the tail, and how its points are drawn: 1 - u = TAIL t^3, of weight 3 t^2.
TAIL = 0.02
_LEAST_TAIL = 1e-12
_LEAST_COSINE = 1e-9


@kernel
def gather(values, stride, parametrization, rows, columns, light, exits, source, taus, key, out):
    """Energy that leaves into the cells of a folded slice.

    Parameters
    ----------
    values : ndarray, shape (azimuths, polar angles, n)
        Radiance at the nodes: outside, or below an exit.
    stride : int
    parametrization, rows, columns : int
    light : ndarray, shape (3,)
    exits : ndarray, shape (0,) or (2,)
        Width of the exit and its index inside over outside, or nothing.
    source : ndarray, shape (0,) or (2,)
        The same of a top interface that the light itself comes through, for the first ``len(taus)`` of the n.
    taus : ndarray, shape (channels,)
        Optical depths before the exit.
    key : uint64
        Of the replicate.
    out : ndarray, shape (n, rows * width)
    """
    found = np.empty(out.shape[0])
    core = np.empty((POINTS, out.shape[0]))
    x = np.empty(POINTS)
    y = np.empty(POINTS)
    z = np.empty(POINTS)
    measure = np.empty(POINTS)
    width = out.shape[1] // rows
    cells_key = derive_key(key, CELLS)
    # A smooth exit has one facet.
    rough = exits.shape[0] > 0 and exits[0] > 0.0
    for cell in range(out.shape[1]):
        for e in range(out.shape[0]):
            out[e, cell] = 0.0
        cell_key = derive_key(cells_key, cell)
        u1 = uniform(cell_key, 0)
        u2 = uniform(cell_key, 1)
        if not _points(parametrization, cell // width, cell % width, rows, columns, light, u1, u2, x, y, z, measure):
            continue
        facets = POINTS + (TAILS if rough else 0)
        for j in range(facets):
            tail = j >= POINTS
            i = 2 * (j - POINTS) if tail else j
            t = coordinate(uniform(cell_key, 5), j, 1.0 / TAILS)
            height = 1.0 - max(TAIL * t * t * t, _LEAST_TAIL) if tail else (1.0 - TAIL) * uniform(cell_key, 3)
            azimuth = uniform(cell_key, 4 if tail else 2)
            azimuth = coordinate(azimuth, i, 1.0 / POINTS)
            _radiance(x[i], y[i], z[i], azimuth, height, exits, source, light, taus, stride, values, found)
            share = measure[i] * (3.0 * t * t * TAIL / TAILS if tail else 1.0 / POINTS)
            for e in range(found.shape[0]):
                out[e, cell] += share * (found[e] - core[i, e] if tail else found[e])
                core[i, e] = core[i, e] if tail else found[e]


@stage
def _points(parametrization, row, column, rows, columns, light, u1, u2, x, y, z, measure):
    """Points of a cell and cos(theta_v) d omega_v at each, times the cell; whether any is above the horizon."""
    height = HALF_PI / rows
    breadth = 2.0 * math.pi / columns
    above = False
    for i in range(POINTS):
        p = u1 if i % 2 == 0 else u2
        q = u2 if i % 2 == 0 else 1.0 - u1
        p = 1.0 - p if i >= 2 else p
        q = 1.0 - q if i >= 2 else q
        sine, cosine, jacobian = view_row(parametrization, (row + p) * height)
        sin_phi, cos_phi = sincos_turns((column + q) / columns)
        x[i], y[i], z[i], rest = view_direction(
            parametrization, sine, cosine, cos_phi, sin_phi, light[0], light[1], light[2]
        )
        inside = z[i] > 0.0 and rest > 0.0
        measure[i] = z[i] * jacobian * rest * height * breadth if inside else 0.0
        z[i] = z[i] if inside else 1.0
        x[i] = x[i] if inside else 0.0
        y[i] = y[i] if inside else 0.0
        above = above or inside
    return above


@stage
def _radiance(x, y, z, azimuth, height, exits, source, light, taus, stride, values, found):
    """Radiance in the direction (x, y, z) outside, through one facet if there is an exit."""
    gain = 1.0
    if exits.shape[0] > 0:
        alpha = exits[0]
        eta = exits[1]
        sine, cosine = sincos_turns(azimuth)
        mx, my, mz = sample_visible_normal(x, y, z, alpha, cosine, sine, height)
        facet = min(1.0, max(0.0, x * mx + y * my + z * mz))
        reflectance, cos_t = fresnel_dielectric(facet, eta)
        along = facet / eta - cos_t
        x = x / eta - along * mx
        y = y / eta - along * my
        z = z / eta - along * mz
        gain = (1.0 - reflectance) * smith_g1(z, alpha) / (eta * eta)
        z = max(z, _LEAST_COSINE)
    interpolate(x, y, z, stride, values, found)
    if source.shape[0] > 0:
        value, facet = microfacet_transmission(x, y, z, light[0], light[1], light[2], source[0], source[1])
        value *= source[1] * source[1] * dielectric_transmittance(facet, source[1])
        for c in range(taus.shape[0]):
            found[c] += value
    if exits.shape[0] > 0:
        path = path_length(z)
        for e in range(found.shape[0]):
            found[e] *= gain * transmittance(taus[e % taus.shape[0]], path)
