"""Fresnel's equations for unpolarised light, by relative index."""

from mpmath import mp, mpc, mpf, sqrt


def cos_t(cos_i, eta):
    """Cosine of the refracted ray by Snell; 0 under total internal reflection."""
    square = 1 - (1 - cos_i**2) / eta**2
    return sqrt(square) if square > 0 else mpf(0)


def dielectric_reflectance(cos_i, eta):
    """Mean of the two polarisations."""
    t = cos_t(cos_i, eta)
    if t == 0:
        return mpf(1)
    s = (cos_i - eta * t) / (cos_i + eta * t)
    p = (eta * cos_i - t) / (eta * cos_i + t)
    return (s**2 + p**2) / 2


def dielectric_transmittance(cos_i, eta):
    """What is not reflected."""
    return 1 - dielectric_reflectance(cos_i, eta)


def conductor_reflectance(cos_i, eta, kappa):
    """Complex index eta + i kappa; g = sqrt(n^2 - sin^2) on the principal branch."""
    n2 = mpc(eta, kappa) ** 2
    g = sqrt(n2 - (1 - cos_i**2))
    s = abs((cos_i - g) / (cos_i + g)) ** 2
    p = abs((n2 * cos_i - g) / (n2 * cos_i + g)) ** 2
    return mp.re(s + p) / 2


def conductor_absorptance(cos_i, eta, kappa):
    """What is not reflected."""
    return 1 - conductor_reflectance(cos_i, eta, kappa)


def facet_cosine(c, square):
    """Of a view whose product with a normal of squared length ``square`` is ``c``."""
    return c / sqrt(square)


def scaled_g(c, square, eta):
    """Eta cos_t, times the length of the normal."""
    return eta * cos_t(facet_cosine(c, square), eta) * sqrt(square)
