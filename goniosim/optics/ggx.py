"""The GGX distribution of microfacets (Trowbridge-Reitz; Walter et al. 2007), isotropic."""

import math

from .._jit import scalar


@scalar
def ggx_density(sin2_h, cos_h, alpha):
    """Density D(h) of microfacet normals, in 1/sr.

    ``sin2_h`` and ``cos_h`` are given separately because cos^2 (alpha^2 - 1) + 1, written as
    alpha^2 cos^2 + sin^2, keeps its digits for narrow distributions.
    """
    t = alpha * alpha * cos_h * cos_h + sin2_h
    return alpha * alpha / (math.pi * t * t) if cos_h > 0.0 else 0.0


@scalar
def smith_g1(cos_w, alpha):
    """Smith masking G1 = 1 / (1 + Lambda) of a direction at ``cos_w`` from the normal; 0 below."""
    root = math.sqrt(cos_w * cos_w + alpha * alpha * (1.0 - cos_w * cos_w))
    return 2.0 * cos_w / (cos_w + root) if cos_w > 0.0 else 0.0


@scalar
def smith_g1_scaled(height, scale, alpha):
    """`smith_g1` of the direction whose cosine is ``height / scale``, and ``1 / scale``: one division for both.

    ``scale`` and ``alpha`` are positive.
    """
    above = max(0.0, height)
    total = above + math.sqrt(above * above + alpha * alpha * (scale * scale - above * above))
    inverse = 1.0 / (scale * total)
    return 2.0 * above * scale * inverse, total * inverse


@scalar
def sample_visible_normal(x, y, z, alpha, cosine, sine, u):
    """A microfacet normal as seen from the unit direction (x, y, z), z > 0.

    The density is G1 D(m) max(0, w.m) / w_z. In the space where the microfacets form a
    hemisphere, the mirror image of the view is uniform on a spherical cap (Dupuy and
    Benyoub 2023): ``cosine`` and ``sine`` are those of a uniform azimuth, and ``u``,
    uniform in [0, 1), sets the height on the cap.
    """
    hx, hy, hz = sample_visible_facet(x, y, z, alpha, cosine, sine, u)
    inverse = 1.0 / math.sqrt(hx * hx + hy * hy + hz * hz)
    return hx * inverse, hy * inverse, hz * inverse


@scalar
def sample_visible_facet(x, y, z, alpha, cosine, sine, u):
    """As `sample_visible_normal`, but the normal is left at a length that needs no division to find."""
    sx = alpha * x
    sy = alpha * y
    flat = sx * sx + sy * sy
    reach = math.sqrt(flat + z * z) + z
    # The height of the cap's point plus z, formed without subtracting: it is the z of the
    # half vector, whose smallness decides the tails of narrow distributions.
    hz = (1.0 - u) * reach
    # The squared length less the squared height, (u reach) (flat / reach + hz): the facets that all but face the view,
    # and those that it all but misses, keep their digits.
    ring = math.sqrt(u * (flat + hz * reach))
    return alpha * (ring * cosine + sx), alpha * (ring * sine + sy), hz
