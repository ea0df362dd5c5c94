"""The direct reflection off the top interface, integrated over every cell instead of sampled.

The energy of a cell is the integral over it of F D G1(l) G1(v) / (4 l_z). Each cell is cut in two
or four until the sum of the Gauss-Legendre rules of the parts agrees with that of the whole; around
the mirror direction it is first cut down to the width of the lobe, which may be a thousand times
narrower than a cell and would otherwise be missed.
"""

import math

import numpy as np

from .._jit import kernel, stage
from ..optics.elementary import TWO_PI
from ..optics.fresnel import fresnel_conductor, fresnel_dielectric
from ..optics.microfacet import microfacet_reflection
from ..slices import PARAMETRIZATIONS, cells_of, horizon_azimuth, horizon_coordinate, view_direction
from ..slices.grid import HALF_PI
from .stages import LAMBERT, ROUGH_CONDUCTOR, ROUGH_DIELECTRIC, SMOOTH_CONDUCTOR, SMOOTH_DIELECTRIC

# Accuracy of a cell, and the energy below which it does not matter.
RELATIVE_TOLERANCE = 1e-8
ABSOLUTE_TOLERANCE = 1e-14
# A first look at a cell, which tells what its accuracy is relative to.
ROUGH_TOLERANCE = 1e-2
MAX_DEPTH = 40
MAX_PARTS = 20_000

_x, _w = np.polynomial.legendre.leggauss(5)
_NODES = 0.5 * (1.0 + _x)
_WEIGHTS = 0.5 * _w


def direct_reflection(plan, direction):
    """Energy that leaves into every cell after a single event on the top interface.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    direction : int
        Index of the incident direction.

    Returns
    -------
    energy, error : ndarray, shape (distinct channels, rows, columns)
        Fraction of the incident flux, and an estimate of the error of its integration.
    """
    kind, alpha, eta = int(plan.kinds[0]), float(plan.alphas[0]), float(plan.etas[0])
    spectral = plan.spectral[0]
    light = plan.light[direction]
    shape = (plan.n_distinct, plan.rows, plan.columns)
    if kind == LAMBERT:
        cosines = plan.geometry[direction].projected_solid_angle
        return spectral[0][:, None, None] * cosines / math.pi, np.zeros(shape)
    if kind in (SMOOTH_DIELECTRIC, SMOOTH_CONDUCTOR):
        energy = np.zeros(shape)
        for c in range(plan.n_distinct):
            energy[c].flat[mirror_cell(plan, direction)] = _reflectance(kind, eta, spectral[:, c], light[2])
        return energy, np.zeros(shape)
    module = PARAMETRIZATIONS[plan.parametrization_name][1]
    theta = math.radians(plan.theta_deg[direction])
    peak = module.mirror_coordinate(theta)
    scale_u, scale_phi = module.lobe_scales(alpha, theta)
    # The azimuth matters everywhere, on the scale of a radian.
    scales = np.array([0.25 * scale_u, min(0.25 * scale_phi, 0.5)])
    energy = np.zeros(shape)
    error = np.zeros(shape)
    # The index of a dielectric is the same in all channels.
    computed = plan.n_distinct if kind == ROUGH_CONDUCTOR else 1
    for c in range(computed):
        for row in range(plan.rows):  # one call would keep Ctrl-C waiting on fine slices
            surface = (kind, alpha, eta, spectral[:, c], plan.parametrization, light)
            _integrate_row(surface, peak, scales, row, energy[c], error[c])
    energy[computed:] = energy[0]
    error[computed:] = error[0]
    return energy, error


def mirror_cell(plan, direction):
    """Number of the cell that holds the mirror direction, by the tie rule of `goniosim.slices`."""
    light = plan.light[direction]
    cell = np.empty(1, np.int32)
    # The view vector minus its horizontal part: that of the mirror direction is the light itself.
    x, y, z = light[:, None].copy()
    _find_cells(plan.parametrization, x, y, z, 1, plan.rows, plan.columns, light, cell)
    return int(cell[0])


@kernel
def _find_cells(parametrization, x, y, z, n, rows, columns, light, cell):
    cells_of(parametrization, x, y, z, n, rows, columns, light, cell)


@kernel
def _reflectance(kind, eta, spectral, cosine):
    return _fresnel(kind, eta, spectral, cosine)


@stage
def _fresnel(kind, eta, spectral, cosine):
    if kind in (ROUGH_DIELECTRIC, SMOOTH_DIELECTRIC):
        reflectance, _ = fresnel_dielectric(cosine, eta)
        return reflectance
    return fresnel_conductor(cosine, spectral[0], spectral[1])


@kernel
def _integrate_row(surface, peak, scales, row, energy, error):
    rows, columns = energy.shape
    d_u = HALF_PI / rows
    d_phi = TWO_PI / columns
    todo = np.empty((4 * MAX_DEPTH + 4, 6))
    # Light stands at azimuth 0: the slice is its own mirror image.
    for column in range((columns + 1) // 2):
        u = row * d_u
        phi = column * d_phi
        # Of the middle one of an odd number of columns, one half.
        copies = 2.0 if 2 * column + 1 == columns else 1.0
        width = d_phi / copies
        relative = ROUGH_TOLERANCE
        absolute = ABSOLUTE_TOLERANCE
        for _ in range(2):
            value, accuracy = _integrate_cell(surface, peak, scales, (u, phi, d_u, width), relative, absolute, todo)
            if accuracy <= RELATIVE_TOLERANCE * value + ABSOLUTE_TOLERANCE:
                break
            # Relative to the cell and not to its parts: for very narrow lobes at grazing angles the
            # rounding of the half vector keeps a part from ever reaching a relative accuracy.
            relative = 0.0
            absolute = 0.1 * RELATIVE_TOLERANCE * value + ABSOLUTE_TOLERANCE
        for j in (column, columns - 1 - column):
            energy[row, j] = copies * value
            error[row, j] = copies * accuracy


@stage
def _integrate_cell(surface, peak, scales, cell, relative, absolute, todo):
    """Integral and error estimate over one cell.

    Parameters
    ----------
    surface : tuple
        Kind, alpha, eta and spectral row of the interface, parametrization, light.
    peak : float
        Row coordinate of the mirror direction.
    scales : ndarray, shape (2,)
        Width of the lobe in row coordinate and azimuth.
    cell : tuple
        Row coordinate, azimuth, and the two widths of the cell.
    relative, absolute : float
        Accuracy of every part.
    todo : ndarray, shape (>= 4 MAX_DEPTH, 6)
        A stack of parts: u, phi, the two widths, the rule on the part, its depth.
    """
    _, _, _, _, parametrization, light = surface
    u, phi, d_u, d_phi = cell
    whole = _rule(surface, u, phi, d_u, d_phi)
    todo[0] = (u, phi, d_u, d_phi, whole, 0.0)
    n = 1
    total = 0.0
    error = 0.0
    visited = 0
    while n > 0:
        n -= 1
        visited += 1
        u, phi, d_u, d_phi, whole, depth = todo[n]
        # Halves of a part that is mostly hidden would agree with it without being any finer.
        d_u = min(d_u, horizon_coordinate(parametrization, phi, light[0], light[2]) - u)
        if d_u <= 0.0:
            continue
        # In units of the lobe's widths.
        long_u = d_u / scales[0]
        long_phi = d_phi / scales[1]
        # At the pole the lobe lies at every azimuth.
        near_in_phi = (abs(phi + 0.5 * d_phi - math.pi) <= d_phi) | (peak <= d_u)
        near = (abs(u + 0.5 * d_u - peak) <= d_u) & near_in_phi
        holds_peak = near & (max(long_u, long_phi) > 1.0)
        # Across only, on the way to the peak; everywhere else the error must show in both directions.
        n_u = 1 if holds_peak & (long_phi > 4.0 * long_u) else 2
        n_phi = 1 if holds_peak & (long_u > 4.0 * long_phi) else 2
        part_u = d_u / n_u
        part_phi = d_phi / n_phi
        parts = 0.0
        for i in range(n_u):
            for j in range(n_phi):
                start_u = u + i * part_u
                start_phi = phi + j * part_phi
                value = _rule(surface, start_u, start_phi, part_u, part_phi)
                todo[n + n_phi * i + j] = (start_u, start_phi, part_u, part_phi, value, depth + 1)
                parts += value
        difference = abs(parts - whole)
        settled = (difference <= relative * parts + absolute) & (not holds_peak)
        if settled | (depth >= MAX_DEPTH) | (visited >= MAX_PARTS):
            total += parts
            error += difference
        else:
            n += n_u * n_phi
    return total, error


@stage
def _rule(surface, u, phi, d_u, d_phi):
    """Gauss-Legendre rules on one rectangle of the slice, cut where the horizon leaves it.

    Rows below the first of the two cuts are wholly visible, those above the second not at all.
    """
    _, _, _, _, parametrization, light = surface
    first = min(max(horizon_coordinate(parametrization, phi + d_phi, light[0], light[2]) - u, 0.0), d_u)
    second = min(max(horizon_coordinate(parametrization, phi, light[0], light[2]) - u, 0.0), d_u)
    total = 0.0
    if first > 0.0:
        total += _smooth_rule(surface, u, phi, first, d_phi)
    if second > first:
        total += _smooth_rule(surface, u + first, phi, second - first, d_phi)
    return total


@stage
def _smooth_rule(surface, u, phi, d_u, d_phi):
    kind, alpha, eta, spectral, parametrization, light = surface
    lx = light[0]
    ly = light[1]
    lz = light[2]
    total = 0.0
    for i in range(_NODES.shape[0]):
        at = u + d_u * _NODES[i]
        # Only the azimuths above the horizon, which would be a kink in the integrand.
        width = min(d_phi, horizon_azimuth(parametrization, at, lx, lz) - phi)
        if width <= 0.0:
            continue
        for j in range(_NODES.shape[0]):
            vx, vy, vz, jacobian = view_direction(parametrization, at, phi + width * _NODES[j], lx, ly, lz)
            lobe, cosine = microfacet_reflection(lx, ly, lz, vx, vy, vz, alpha)
            value = lobe * _fresnel(kind, eta, spectral, cosine) * max(0.0, vz) * jacobian
            total += _WEIGHTS[i] * _WEIGHTS[j] * value * width
    return total * d_u
