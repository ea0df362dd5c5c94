"""Fresnel reflectance of unpolarised light.

Refractive indices are relative: that of the side the light goes to over that of the side it
comes from.
"""

import math

from .._jit import scalar


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
    sin2_t = (1.0 - cos_i * cos_i) / (eta * eta)
    total = sin2_t >= 1.0
    cos_t = math.sqrt(max(0.0, 1.0 - sin2_t))
    sum_s = cos_i + eta * cos_t
    sum_p = eta * cos_i + cos_t
    # One division for both polarisations.
    inverse = 1.0 / (sum_s * sum_p)
    r_s = (cos_i - eta * cos_t) * sum_p * inverse
    r_p = (eta * cos_i - cos_t) * sum_s * inverse
    reflectance = 1.0 if total else 0.5 * (r_s * r_s + r_p * r_p)
    return reflectance, cos_t


@scalar
def fresnel_conductor(cos_i, eta, kappa):
    """Reflectance of a conductor of relative index eta + i kappa.

    The real form of |(c - g)/(c + g)|^2 and |(r^2 c - g)/(r^2 c + g)|^2 with
    g = sqrt(r^2 - sin^2), averaged over both polarisations.
    """
    # Keeps 0/0 away from an index-matched base met at exactly grazing incidence.
    c = max(cos_i, 1e-12)
    c2 = c * c
    s2 = 1.0 - c2
    eta2 = eta * eta
    kappa2 = kappa * kappa
    t0 = eta2 - kappa2 - s2
    a2_b2 = math.sqrt(t0 * t0 + 4.0 * eta2 * kappa2)
    t1 = a2_b2 + c2
    t2 = 2.0 * c * math.sqrt(max(0.0, 0.5 * (a2_b2 + t0)))
    t3 = c2 * a2_b2 + s2 * s2
    t4 = t2 * s2
    # One division for both polarisations.
    inverse = 1.0 / ((t1 + t2) * (t3 + t4))
    r_s = max(0.0, (t1 - t2) * (t3 + t4) * inverse)
    r_p = r_s * max(0.0, (t3 - t4) * (t1 + t2) * inverse)
    return 0.5 * (r_s + r_p)
