"""Fresnel reflectance of unpolarised light, and what is left of the flux.

Refractive indices are relative: that of the side the light goes to over that of the side it
comes from. With m = (n - 1)(n + 1) for an index n, real or complex, the cosine c and g = n cos_t,

    g^2 = m + c^2,    r_s = (c - g) / (c + g) = -m / (c + g)^2,
    r_p = (n^2 c - g) / (n^2 c + g) = m ((n^2 + 1) c^2 - 1) / (n^2 c + g)^2.

Nearly equal numbers are never subtracted, so that what is small keeps its digits: reflectances near
an index of 1, and 1 - R of a good mirror or at grazing incidence.
"""

import math

from .._jit import scalar
from .elementary import fma

# Keeps 0/0 away from equal indices met at exactly grazing incidence.
_LEAST_COSINE = 1e-60


@scalar
def _square_minus_one(eta):
    """eta^2 - 1 for eta < 1 as a sum of two numbers, the second being the rounding error of the first.

    Near the critical angle the first one cancels. For eta > 1 nothing does, and the second means nothing.
    """
    # eta - 1 is exact from 1/2 to 2; below, eta^2 is the small term. Each difference below is exact.
    factor = eta - 1.0 if eta >= 0.5 else eta
    term = factor if eta >= 0.5 else -1.0
    m = fma(factor, eta, term)
    return m, fma(factor, eta, term - m)


@scalar
def fresnel_dielectric(cos_i, eta):
    """Reflectance of a dielectric and cosine of the refracted ray.

    Parameters
    ----------
    cos_i : float
        Cosine of the angle of incidence, in [0, 1].
    eta : float
        Relative index n_t / n_i.

    Returns
    -------
    reflectance, cos_t : float
        1 and 0 under total internal reflection.
    """
    c, g, g2, m, sum_s, sum_p = _dielectric(cos_i, 1.0, eta)
    # One division for both polarisations.
    inverse = 1.0 / (sum_s * sum_p)
    inverse_s = sum_p * inverse
    inverse_p = sum_s * inverse
    r_s = m * inverse_s * inverse_s
    r_p = m * _brewster(c, g2, 1.0, eta) * inverse_p * inverse_p
    reflectance = 1.0 if g2 <= 0.0 else min(1.0, 0.5 * (r_s * r_s + r_p * r_p))
    return reflectance, g / eta


@scalar
def reflects(u, c, square, eta):
    """Whether a dielectric reflects a ray: the coin that falls with the reflectance, thrown without a division.

    Parameters
    ----------
    u : float
        Uniform in [0, 1).
    c : float
        Product of the view and a normal of any length, not negative.
    square : float
        Squared length of that normal.
    eta : float
        Relative index n_t / n_i.

    Returns
    -------
    reflect : bool
        ``u < reflectance`` of `fresnel_dielectric`.
    g : float
        ``eta cos_t`` times the length of the normal; 0 under total internal reflection.
    """
    c, g, g2, m, sum_s, sum_p = _dielectric(c, square, eta)
    # r_s and r_p times the same factor
    p = sum_s * sum_p
    s_part = m * square * sum_p * sum_p
    p_part = m * _brewster(c, g2, square, eta) * sum_s * sum_s
    wins = 2.0 * u * (p * p) * (p * p) < s_part * s_part + p_part * p_part
    return wins | (g2 <= 0.0), g


@scalar
def dielectric_transmittance(cos_i, eta):
    """1 - R of a dielectric, to full relative accuracy; 0 under total internal reflection.

    Arguments as in `fresnel_dielectric`.
    """
    c, g, _, _, sum_s, sum_p = _dielectric(cos_i, 1.0, eta)
    inverse = 1.0 / (sum_s * sum_p)
    inverse_s = sum_p * inverse
    inverse_p = sum_s * inverse
    return min(1.0, 2.0 * c * g * (inverse_s * inverse_s + eta * eta * inverse_p * inverse_p))


@scalar
def scaled_transmittance(c, square, eta):
    """`dielectric_transmittance` at a normal of any length; arguments and g as in `reflects`."""
    c, g, _, _, sum_s, sum_p = _dielectric(c, square, eta)
    # Both polarisations of `dielectric_transmittance` over the same denominator; the length cancels.
    p = sum_s * sum_p
    return min(1.0, 2.0 * c * g * (sum_p * sum_p + eta * eta * sum_s * sum_s) / (p * p)), g


@scalar
def _dielectric(c, square, eta):
    """The cosine, g, g^2 or less than 0 where all is reflected, m, c + g and eta^2 c + g.

    All but m are times the length, or squared length, of a normal whose squared length is ``square``.
    """
    c = max(c, _LEAST_COSINE)
    m, rest = _square_minus_one(eta)
    g2 = fma(c, c, m * square) + rest * square
    g = math.sqrt(max(0.0, g2))
    return c, g, g2, m, c + g, eta * eta * c + g


@scalar
def _brewster(c, g2, square, eta):
    """(n^2 + 1) c^2 - 1, which is also (n^2 + 1) g^2 - n^4; times ``square`` as in `_dielectric`."""
    eta2 = eta * eta
    return (eta2 + 1.0) * (g2 if eta < 1.0 else c * c) - (eta2 * eta2 if eta < 1.0 else 1.0) * square


@scalar
def fresnel_conductor(cos_i, eta, kappa):
    """Reflectance of a conductor of relative index eta + i kappa.

    R_s = |m|^2 / |c + g|^4 and R_p = R_s |g c - s^2|^2 / |g c + s^2|^2 with s the sine; their mean has
    no difference left.
    """
    scale, _, t3, _, _, inverse = _conductor(cos_i, eta, kappa)
    below = eta - 1.0
    above = eta + 1.0
    m2 = (below * below + kappa * kappa) * (above * above + kappa * kappa)
    return min(1.0, m2 * scale * scale * t3 * inverse)


@scalar
def conductor_absorptance(cos_i, eta, kappa):
    """1 - R of a conductor, to full relative accuracy; arguments as in `fresnel_conductor`."""
    _, t2, t3, s2, sum_s, inverse = _conductor(cos_i, eta, kappa)
    return min(1.0, t2 * (2.0 * t3 + s2 * sum_s) * sum_s * inverse)


@scalar
def _conductor(cos_i, eta, kappa):
    """What reflectance and absorptance share.

    Returns
    -------
    scale, t2, t3, s2, sum_s, inverse : float
        A scale; multiplied by it 2 c Re g and |g c|^2 + s^4; s^2; sum_s, the scaled |c + g|^2; and
        1 / (sum_s^2 sum_p) with sum_p the scaled |g c + s^2|^2.
    """
    c = max(cos_i, _LEAST_COSINE)
    c2 = c * c
    s2 = (1.0 - c) * (1.0 + c)
    # g^2 = real + 2 i product; the larger one of Re g and Im g is a root without differences.
    m, rest = _square_minus_one(eta)
    real = fma(c, c, m) + (rest - kappa * kappa)
    product = eta * kappa
    modulus = math.sqrt(real * real + 4.0 * product * product)
    larger = math.sqrt(0.5 * (modulus + abs(real)))
    # The other one is product / larger: where that is Re g, everything is multiplied by larger instead.
    scale = larger if real < 0.0 else 1.0
    t2 = 2.0 * c * (product if real < 0.0 else larger)
    t3 = scale * (c2 * modulus + s2 * s2)
    sum_s = scale * (modulus + c2) + t2
    sum_p = t3 + s2 * t2
    return scale, t2, t3, s2, sum_s, 1.0 / (sum_s * sum_s * sum_p)
