"""The reflection of a microfacet surface (Cook and Torrance; Walter et al. 2007, Eq. 20)."""

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
