"""Rectangles of a slice, cut where the horizon leaves them, and the view directions in them."""

import math

import numpy as np

from .._jit import kernel, stage
from ..slices import horizon_azimuth, horizon_coordinate, view_direction, view_row

# Columns of a table of rectangles, in radians: lower row coordinate and azimuth, and the two widths. The
# azimuth is measured from the mirror direction, pi - phi: there lobes can be needles narrower than the
# spacing of the numbers around pi.
U, PSI, D_U, D_PSI = range(4)


@kernel
def fill(code, light, rectangles, nodes, x, y, z, weight):
    """View directions at the nodes of rectangles, and cos(theta_v) d omega_v over the weights of the rule."""
    lx = light[0]
    ly = light[1]
    lz = light[2]
    n = nodes.shape[0]
    cosines = np.empty(n)
    sines = np.empty(n)
    at = 0
    for k in range(rectangles.shape[0]):
        u = rectangles[k, U]
        psi = rectangles[k, PSI]
        d_u = rectangles[k, D_U]
        d_psi = rectangles[k, D_PSI]
        is_cut = horizon_coordinate(code, math.pi - psi, lx, lz) < u + d_u
        width = d_psi
        _turn(psi, width, nodes, cosines, sines)
        for i in range(n):
            here = u + d_u * nodes[i]
            sine, cosine, row_factor = view_row(code, here)
            if is_cut:
                # Only the azimuths above the horizon, which would be a kink in the integrand.
                hidden = min(max(math.pi - horizon_azimuth(code, here, lx, lz) - psi, 0.0), d_psi)
                width = d_psi - hidden
                _turn(psi + hidden, width, nodes, cosines, sines)
            area = d_u * width * row_factor
            here_x = x[at : at + n]
            here_y = y[at : at + n]
            here_z = z[at : at + n]
            here_weight = weight[at : at + n]
            for j in range(n):
                vx, vy, vz, factor = view_direction(code, sine, cosine, cosines[j], sines[j], lx, ly, lz)
                here_x[j] = vx
                here_y[j] = vy
                # Rounding must not hide what lies in the horizon.
                here_z[j] = max(vz, 1e-12)
                here_weight[j] = area * factor * max(vz, 0.0)
            at += n


@stage
def _turn(psi, width, nodes, cosines, sines):
    for j in range(nodes.shape[0]):
        azimuth = psi + width * nodes[j]
        cosines[j] = -math.cos(azimuth)
        sines[j] = math.sin(azimuth)
