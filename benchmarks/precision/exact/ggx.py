"""The GGX distribution, Smith's masking and visible normals (Walter et al. 2007; Dupuy and Benyoub 2023)."""

from mpmath import mpf, pi, sqrt


def density(sin2_h, cos_h, alpha):
    """D of a normal whose squared sine and whose cosine are given."""
    tan2 = sin2_h / cos_h**2
    return 1 / (pi * alpha**2 * cos_h**4 * (1 + tan2 / alpha**2) ** 2)


def smith_lambda(cos_w, alpha):
    """Smith's Lambda of GGX: (-1 + sqrt(1 + alpha^2 tan^2)) / 2."""
    tan2 = (1 - cos_w**2) / cos_w**2
    return (sqrt(1 + alpha**2 * tan2) - 1) / 2


def smith_g1(cos_w, alpha):
    """Fraction of the projected facets that is seen; 0 from below."""
    return 1 / (1 + smith_lambda(cos_w, alpha)) if cos_w > 0 else mpf(0)


def correlated(g_l, g_v):
    """1 / (1 + Lambda(l) + Lambda(v)) over the product of both G1."""
    return 1 / (1 + (1 / g_l - 1) + (1 / g_v - 1)) / (g_l * g_v)


def visible_normal(x, y, z, alpha, cosine, sine, u):
    """The unit normal that belongs to an azimuth and to a uniform number.

    Stretched by 1 / alpha the facets are a hemisphere, and the mirror image of the view on a visible one is uniform
    over the cap of the sphere above the height of minus the view.
    """
    length = sqrt((alpha * x) ** 2 + (alpha * y) ** 2 + z**2)
    w = (alpha * x / length, alpha * y / length, z / length)
    height = 1 - u * (1 + w[2])
    ring = sqrt(max(mpf(0), 1 - height**2))
    h = (ring * cosine + w[0], ring * sine + w[1], height + w[2])
    m = (alpha * h[0], alpha * h[1], h[2])
    norm = sqrt(m[0] ** 2 + m[1] ** 2 + m[2] ** 2)
    return tuple(component / norm for component in m)


def visible_density(view, normal, alpha):
    """G1 D(m) max(0, w.m) / w_z, in 1/sr."""
    facing = sum(a * b for a, b in zip(view, normal, strict=True))
    d = density(1 - normal[2] ** 2, normal[2], alpha)
    return smith_g1(view[2], alpha) * d * max(mpf(0), facing) / view[2]
