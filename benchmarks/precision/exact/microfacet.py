"""A microfacet surface (Walter et al. 2007, Eqs. 16, 20 and 21), without its Fresnel factor.

Directions are what they are given as, unit vectors but for their rounding.
"""

from mpmath import mpf, sqrt

from . import ggx


def _unit(vector):
    norm = sqrt(sum(a * a for a in vector))
    return [a / norm for a in vector], norm


def reflection(lx, ly, lz, vx, vy, vz, alpha):
    """D G / (4 l_z v_z) at the half vector."""
    h, _ = _unit((lx + vx, ly + vy, lz + vz))
    d = ggx.density(h[0] ** 2 + h[1] ** 2, h[2], alpha)
    return d * ggx.smith_g1(lz, alpha) * ggx.smith_g1(vz, alpha) / (4 * lz * vz)


def reflection_cosine(lx, ly, lz, vx, vy, vz):
    """l.h, which is half the length of l + v."""
    return _unit((lx + vx, ly + vy, lz + vz))[1] / 2


def _facet(light, view, eta):
    """The facet h_t = -(eta l + v) / |..|, turned to the side of the viewer; its l.h and v.h, and |eta l + v|."""
    h, norm = _unit([-(eta * a + b) for a, b in zip(light, view, strict=True)])
    h = h if h[2] > 0 else [-a for a in h]
    return h, *(sum(a * b for a, b in zip(w, h, strict=True)) for w in (light, view)), norm


def transmission(bx, by, bz, vx, vy, vz, alpha, eta):
    """|l.h| |v.h| D G / (|l_z| |v_z| (eta l.h + v.h)^2); 0 if the facet does not face both."""
    h, to_light, to_view, norm = _facet((bx, by, -bz), (vx, vy, vz), eta)
    if to_view <= 0 or to_light >= 0:
        return mpf(0)
    d = ggx.density(h[0] ** 2 + h[1] ** 2, h[2], alpha)
    masking = ggx.smith_g1(bz, alpha) * ggx.smith_g1(vz, alpha)
    # eta l.h + v.h = |eta l + v|, since h is parallel to it.
    return -to_light * to_view * d * masking / (bz * vz * norm**2)


def transmission_cosine(bx, by, bz, vx, vy, vz, eta):
    """v.h; 0 if the facet does not face both."""
    _, to_light, to_view, _ = _facet((bx, by, -bz), (vx, vy, vz), eta)
    return to_view if to_view > 0 > to_light else mpf(0)
