"""Reflection and transmission of a microfacet surface (Cook and Torrance; Walter et al. 2007, Eqs. 20 and 21)."""

import math

from .._jit import scalar
from .ggx import ggx_density, smith_g1


@scalar
def microfacet_reflection(lx, ly, lz, vx, vy, vz, alpha):
    """GGX reflection without its Fresnel factor, and the cosine at the microfacet.

    Parameters
    ----------
    lx, ly, lz, vx, vy, vz : float
        Unit directions to the light and to the viewer.
    alpha : float
        GGX width, > 0.

    Returns
    -------
    value : float
        D G1(l) G1(v) / (4 l_z v_z) in 1/sr; 0 if a direction is not above the surface.
    cosine : float
        l.h, the argument of the Fresnel factor.
    """
    hx = lx + vx
    hy = ly + vy
    hz = lz + vz
    square = hx * hx + hy * hy + hz * hz
    inverse = 1.0 / math.sqrt(max(square, 1e-300))
    hx *= inverse
    hy *= inverse
    hz *= inverse
    # l.h = |l + v| / 2: the same for l and v to the last bit, and exact where both graze.
    cosine = min(1.0, 0.5 * square * inverse)
    above = (lz > 0.0) & (vz > 0.0)
    d = ggx_density(hx * hx + hy * hy, hz, alpha)
    g = smith_g1(lz, alpha) * smith_g1(vz, alpha)
    value = d * g / (4.0 * lz * vz) if above else 0.0
    return value, cosine


@scalar
def microfacet_transmission(bx, by, bz, vx, vy, vz, alpha, eta):
    """GGX transmission without its Fresnel factor, and the cosine at the microfacet on the viewer's side.

    Parameters
    ----------
    bx, by, bz : float
        Unit direction to the light, with bz > 0 on the light's side of the interface.
    vx, vy, vz : float
        Unit direction to the viewer, with vz > 0 on the viewer's side.
    alpha : float
        GGX width, > 0.
    eta : float
        Index of the light's side relative to the viewer's; not 1.

    Returns
    -------
    value : float
        D G1(b) G1(v) (b.h) (v.h) / (b_z v_z (eta b + v)^2) in 1/sr; 0 if no facet connects the directions.
    cosine : float
        v.h, the argument of the Fresnel factor of a ray from the viewer's side, of index eta.
    """
    # h points to the side of smaller index, on the viewer's side for eta > 1; then its mirror image is taken.
    side = 1.0 if eta > 1.0 else -1.0
    hx = -side * (eta * bx + vx)
    hy = -side * (eta * by + vy)
    hz = side * (eta * bz - vz)
    inverse2 = 1.0 / max(hx * hx + hy * hy + hz * hz, 1e-300)
    inverse = math.sqrt(inverse2)
    cosine_v = (hx * vx + hy * vy + hz * vz) * inverse
    cosine_b = (hz * bz - hx * bx - hy * by) * inverse
    connected = (cosine_v > 0.0) & (cosine_b > 0.0) & (hz > 0.0) & (bz > 0.0) & (vz > 0.0)
    d = ggx_density((hx * hx + hy * hy) * inverse2, hz * inverse, alpha)
    g = smith_g1(bz, alpha) * smith_g1(vz, alpha)
    value = d * g * cosine_b * cosine_v * inverse2 / (bz * vz) if connected else 0.0
    return value, min(1.0, max(0.0, cosine_v))
