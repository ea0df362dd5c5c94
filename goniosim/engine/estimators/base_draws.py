"""Facets of a dielectric top over a Lambertian base, drawn: for light on its way in and back, and as seen from cells.

Azimuths do not matter: directions are the sine and the cosine of their polar angle. Every function adds to the sums of
its caller what some consecutive points of a lattice contribute.
"""

import math

import numpy as np

from ..._jit import kernel, stage
from ...optics.elementary import sincos_turns
from ...optics.fresnel import dielectric_transmittance, fresnel_dielectric
from ...optics.ggx import sample_visible_normal, smith_g1
from ...optics.medium import path_length, transmittance
from ...optics.random import derive_key, uniform
from ...slices import view_direction
from ..lattice import STEPS, coordinate

# Paths or cells side by side.
BLOCK = 512
# Scratch rows: how a facet is drawn, from where it is seen, and what it does.
COS_AZIMUTH, SIN_AZIMUTH, SHARE, SINE, HEIGHT, GAIN, PATH = range(7)
# Further ones: the place of a cell, its measure and the weight of its facet at a draw, and the shifts of its lattice.
LOW, SPAN, COLUMN, MEASURE, RARITY, SHIFT = range(7, 13)
N_SCRATCH = SHIFT + 4
# Shift with which point 0 of a lattice is in the middle of a cell.
MIDDLE = 0.5
LARGEST_SHARE = 1.0 - 2.0**-52


@kernel
def uniforms(key, n):
    """The first ``n`` random numbers of a key."""
    found = np.empty(n)
    for i in range(n):
        found[i] = uniform(key, i)
    return found


@kernel
def enter(interface, tau, sine, height, first, n, shifts, scratch, sums):
    """Add up what arrives at the base of ``n`` paths from the light, which stands at ``sine``, ``height``."""
    sines = scratch[SINE]
    heights = scratch[HEIGHT]
    for start in range(first, first + n, BLOCK):
        count = min(BLOCK, first + n - start)
        _draw_facets(start, count, shifts, scratch)
        for i in range(count):
            sines[i] = sine
            heights[i] = height
        _refract(interface, count, scratch)
        _add_up(tau, count, scratch, sums)


@kernel
def come_back(interface, tau, first, n, shifts, scratch, sums):
    """Add up what arrives at the base of ``n`` paths that left it with one unit of energy each."""
    for start in range(first, first + n, BLOCK):
        count = min(BLOCK, first + n - start)
        _draw_facets(start, count, shifts, scratch)
        _leave_base(start, count, shifts[2], scratch[SINE], scratch[HEIGHT])
        _reflect(interface, count, scratch)
        _add_up(tau, count, scratch, sums)


@kernel
def look(interface, tau, slices, cells, begin, end, first, n, key, scratch, flat, sums):
    """Add up what ``n`` draws of some cells see of a base of unit radiance.

    Each times cos(theta_v), and in units of the solid angle of the axis over the step of the squared sine.

    Facets far from flat are rare, and let less through than all others. A cell that meets one in ten replicates would
    mostly state too small an error. So they are drawn more often and weighted less. Only differences to the flat
    facet, seen from the middle of the cell, are weighted: elsewhere the weights would be noise.

    Parameters
    ----------
    interface : (float, float)
        GGX width and relative index of the top.
    tau : ndarray, shape (channels,)
    slices : tuple
        Number of the parametrization, squared sines of half the tilt at the edges of rows, cells of a row, columns,
        unit vector to the light.
    cells : ndarray of int, shape (m,)
        Their numbers, ``row * per_row + column``.
    begin, end : int
        From which of them to which, the last one left out.
    first, n : int
        Which points of the lattice of each.
    key : uint64
        Parent of the keys of the cells.
    scratch : ndarray, shape (N_SCRATCH, BLOCK)
    flat : ndarray, shape (channels, BLOCK)
        Overwritten.
    sums : ndarray, shape (channels, m)
    """
    code, edges, per_row, columns, light = slices
    _, eta = interface
    for start in range(begin, end, BLOCK):
        count = min(BLOCK, end - start)
        for i in range(count):
            number = cells[start + i]
            row = number // per_row
            scratch[LOW, i] = edges[row]
            scratch[SPAN, i] = edges[row + 1] - edges[row]
            scratch[COLUMN, i] = number % per_row
            for d in range(4):
                scratch[SHIFT + d, i] = MIDDLE
        _look_from_cells(code, columns, light, 0, count, scratch)
        _refract((0.0, eta), count, scratch)
        _keep_flat(tau, count, scratch, flat)
        for i in range(count):
            own = derive_key(key, cells[start + i])
            for d in range(4):
                scratch[SHIFT + d, i] = uniform(own, d)
        for j in range(first, first + n):
            _look_from_cells(code, columns, light, j, count, scratch)
            _refract(interface, count, scratch)
            _add_to_cells(tau, start, count, scratch, flat, sums)


@stage
def _draw_facets(first, n, shifts, scratch):
    cosines = scratch[COS_AZIMUTH]
    sines = scratch[SIN_AZIMUTH]
    shares = scratch[SHARE]
    for i in range(n):
        sines[i], cosines[i] = sincos_turns(coordinate(shifts[0], first + i, STEPS[0]))
        shares[i] = coordinate(shifts[1], first + i, STEPS[1])


@stage
def _leave_base(first, n, shift, sines, heights):
    for i in range(n):
        u = coordinate(shift, first + i, STEPS[2])
        sines[i] = math.sqrt(u)
        heights[i] = math.sqrt(1.0 - u)


@stage
def _look_from_cells(code, columns, light, number, n, scratch):
    """View directions of draw ``number`` of each of ``n`` cells, uniform in the solid angle of the axis."""
    low = scratch[LOW]
    span = scratch[SPAN]
    column = scratch[COLUMN]
    measure = scratch[MEASURE]
    rarity = scratch[RARITY]
    cosines = scratch[COS_AZIMUTH]
    sines = scratch[SIN_AZIMUTH]
    shares = scratch[SHARE]
    view_sines = scratch[SINE]
    heights = scratch[HEIGHT]
    row_shift = scratch[SHIFT]
    column_shift = scratch[SHIFT + 1]
    azimuth_shift = scratch[SHIFT + 2]
    share_shift = scratch[SHIFT + 3]
    lx = light[0]
    ly = light[1]
    lz = light[2]
    turn = 1.0 / columns
    for i in range(n):
        # With s the sine of half the tilt, s^2 is uniform.
        square = low[i] + span[i] * coordinate(row_shift[i], number, STEPS[0])
        sin_phi, cos_phi = sincos_turns((column[i] + coordinate(column_shift[i], number, STEPS[1])) * turn)
        sine = 2.0 * math.sqrt(square * (1.0 - square))
        vx, vy, vz, jacobian = view_direction(code, sine, 1.0 - 2.0 * square, cos_phi, sin_phi, lx, ly, lz)
        above = vz > 0.0
        # Below the horizon nothing is seen, and any direction will do.
        measure[i] = span[i] * jacobian * vz if above else 0.0
        view_sines[i] = math.sqrt(vx * vx + vy * vy) if above else 0.0
        heights[i] = vz if above else 1.0
    for i in range(n):
        sines[i], cosines[i] = sincos_turns(coordinate(azimuth_shift[i], number, STEPS[2]))
        # Far facets have shares near 1, which a facet must not reach.
        rest = 1.0 - coordinate(share_shift[i], number, STEPS[3])
        shares[i] = min(1.0 - rest * rest, LARGEST_SHARE)
        rarity[i] = 2.0 * rest


@stage
def _refract(interface, n, scratch):
    """Let ``n`` directions above see through a facet: (1 - F) G1, and the way to the base."""
    alpha, eta = interface
    inverse_eta = 1.0 / eta
    cosines = scratch[COS_AZIMUTH]
    azimuth_sines = scratch[SIN_AZIMUTH]
    shares = scratch[SHARE]
    sines = scratch[SINE]
    heights = scratch[HEIGHT]
    gain = scratch[GAIN]
    path = scratch[PATH]
    for i in range(n):
        x = sines[i]
        z = heights[i]
        mx, _, mz = sample_visible_normal(x, 0.0, z, alpha, cosines[i], azimuth_sines[i], shares[i])
        cosine = min(1.0, max(0.0, x * mx + z * mz))
        _, cos_t = fresnel_dielectric(cosine, eta)
        below = z * inverse_eta - (cosine * inverse_eta - cos_t) * mz
        gain[i] = dielectric_transmittance(cosine, eta) * smith_g1(below, alpha)
        path[i] = path_length(below)


@stage
def _reflect(interface, n, scratch):
    """Let a facet of the top reflect ``n`` directions below it: F G1, and the way there and back."""
    alpha, eta = interface
    inverse_eta = 1.0 / eta
    cosines = scratch[COS_AZIMUTH]
    azimuth_sines = scratch[SIN_AZIMUTH]
    shares = scratch[SHARE]
    sines = scratch[SINE]
    heights = scratch[HEIGHT]
    gain = scratch[GAIN]
    path = scratch[PATH]
    for i in range(n):
        x = sines[i]
        z = heights[i]
        mx, _, mz = sample_visible_normal(x, 0.0, z, alpha, cosines[i], azimuth_sines[i], shares[i])
        cosine = min(1.0, max(0.0, x * mx + z * mz))
        reflectance, _ = fresnel_dielectric(cosine, inverse_eta)
        back = 2.0 * cosine * mz - z
        gain[i] = reflectance * smith_g1(back, alpha)
        path[i] = path_length(z) + path_length(back)


@stage
def _add_up(tau, n, scratch, sums):
    gain = scratch[GAIN]
    path = scratch[PATH]
    for c in range(tau.shape[0]):
        depth = tau[c]
        total = 0.0
        if depth > 0.0:
            for i in range(n):
                total += gain[i] * transmittance(depth, path[i])
        else:
            for i in range(n):
                total += gain[i]
        sums[c] += total


@stage
def _keep_flat(tau, n, scratch, flat):
    gain = scratch[GAIN]
    path = scratch[PATH]
    for c in range(tau.shape[0]):
        row = flat[c]
        for i in range(n):
            row[i] = gain[i] * transmittance(tau[c], path[i])


@stage
def _add_to_cells(tau, start, n, scratch, flat, sums):
    gain = scratch[GAIN]
    path = scratch[PATH]
    measure = scratch[MEASURE]
    rarity = scratch[RARITY]
    for c in range(tau.shape[0]):
        depth = tau[c]
        usual = flat[c]
        row = sums[c][start : start + n]
        if depth > 0.0:
            for i in range(n):
                unusual = gain[i] * transmittance(depth, path[i]) - usual[i]
                row[i] += measure[i] * (usual[i] + rarity[i] * unusual)
        else:
            for i in range(n):
                row[i] += measure[i] * (usual[i] + rarity[i] * (gain[i] - usual[i]))
