"""Closed forms of layered materials, and their integrals over the cells of a slice.

Nothing here uses goniosim. Directions point away from the surface, the light
stands at phi = 0, and densities are *flux densities*: the fraction of the
incident flux that leaves per steradian, which is the BSDF times cos(theta_v).
"""

import math

import numpy as np
from scipy.integrate import quad


def fresnel_dielectric(cos_i, n):
    """Unpolarized reflectance for the relative index ``n`` = n_transmitted / n_incident."""
    cos_i = np.asarray(cos_i, dtype=float)
    g2 = n * n - 1.0 + cos_i * cos_i
    g = np.sqrt(np.maximum(g2, 0.0))
    with np.errstate(invalid="ignore", divide="ignore"):
        s = ((cos_i - g) / (cos_i + g)) ** 2
        p = ((n * n * cos_i - g) / (n * n * cos_i + g)) ** 2
        return np.where(g2 <= 0.0, 1.0, 0.5 * (s + p))


def fresnel_conductor(cos_i, n):
    """Unpolarized reflectance for a complex relative index ``n``."""
    cos_i = np.asarray(cos_i, dtype=float)
    n2 = complex(n) ** 2
    g = np.sqrt(n2 - 1.0 + cos_i * cos_i)
    s = np.abs((cos_i - g) / (cos_i + g)) ** 2
    p = np.abs((n2 * cos_i - g) / (n2 * cos_i + g)) ** 2
    return 0.5 * (s + p)


def refracted_cosine(cos_i, n):
    """Cosine below a smooth interface of relative index ``n``, without total reflection."""
    return np.sqrt(1.0 - (1.0 - np.asarray(cos_i) ** 2) / n**2)


# --- smooth coat over a Lambertian base (Saunderson) ------------------------------------------


def internal_reflectance(n, tau=0.0):
    """Share of Lambertian light that a smooth coat sends back to its base, absorption included.

    R_int = 2 int_0^1 F_int(mu) exp(-2 tau / mu) mu dmu; F_int is 1 beyond the critical angle.
    """

    def integrand(mu):
        return 2.0 * mu * float(fresnel_dielectric(mu, 1.0 / n)) * math.exp(-2.0 * tau / mu)

    critical = math.sqrt(1.0 - 1.0 / n**2) if n > 1.0 else 0.0
    below = quad(integrand, 1e-300, critical, epsabs=1e-13, epsrel=1e-12, limit=200)[0] if critical else 0.0
    # F_int rises with infinite slope at the critical angle; mu = critical + t^2 takes it away.
    width = math.sqrt(1.0 - critical)
    start = 0.0 if critical else 1e-150
    above = quad(
        lambda t: 2.0 * t * integrand(critical + t * t), start, width, epsabs=1e-13, epsrel=1e-12, limit=200
    )[0]
    return below + above


def plastic_density(n, rho, tau=0.0):
    """Internal flux density of a smooth coat over a Lambertian base, as a function of cos(theta_v).

    Returns
    -------
    function (cos_l, cos_v) -> density
    """
    bounce = rho / (1.0 - rho * internal_reflectance(n, tau))

    def density(cos_l, cos_v):
        in_l, in_v = refracted_cosine(cos_l, n), refracted_cosine(cos_v, n)
        crossing = (1.0 - fresnel_dielectric(cos_l, n)) * (1.0 - fresnel_dielectric(cos_v, n))
        return crossing * np.exp(-tau / in_l - tau / in_v) * bounce * cos_v / (math.pi * n * n)

    return density


def plastic_albedo(cos_l, n, rho, tau=0.0):
    """Internal albedo of a smooth coat over a Lambertian base."""
    density = plastic_density(n, rho, tau)
    return quad(lambda c: 2.0 * math.pi * float(density(cos_l, c)), 0.0, 1.0, epsabs=1e-13, epsrel=1e-11)[0]


# --- smooth stacks ----------------------------------------------------------------------------


def smooth_metal(cos_l, n, eta, kappa, tau=0.0):
    """Reflectance of a smooth coat over a smooth conductor: direct and internal part.

    Internal: (1-R)^2 R_b a^2 / (1 - R R_b a^2) with a = exp(-tau / c'), c' the cosine in the coat.
    """
    inside = float(refracted_cosine(cos_l, n))
    r = float(fresnel_dielectric(cos_l, n))
    r_base = float(fresnel_conductor(inside, complex(eta, kappa) / n))
    a2 = math.exp(-2.0 * tau / inside)
    return r, (1.0 - r) ** 2 * r_base * a2 / (1.0 - r * r_base * a2)


def smooth_slab(cos_l, n, tau=0.0):
    """Direct and internal reflectance, and transmittance, of a smooth slab in air."""
    r = float(fresnel_dielectric(cos_l, n))
    a = math.exp(-tau / float(refracted_cosine(cos_l, n)))
    echo = 1.0 - (r * a) ** 2
    return r, (1.0 - r) ** 2 * r * a * a / echo, (1.0 - r) ** 2 * a / echo


def smooth_slab_orders(cos_l, n, count, tau=0.0):
    """Energy reflected after 1, 2, ... ``count`` events on the top interface of a smooth slab."""
    r = float(fresnel_dielectric(cos_l, n))
    a = math.exp(-tau / float(refracted_cosine(cos_l, n)))
    return [r] + [(1.0 - r) ** 2 * r ** (2 * k - 1) * a ** (2 * k) for k in range(1, count)]


WHITE_GGX_ALPHA_1_NORMAL = 1.0 - math.log(2.0)
"""Single-scattering albedo of a lossless GGX surface, alpha = 1, at normal incidence."""


# --- rough conductor --------------------------------------------------------------------------


def smith_g1(cos_v, alpha):
    """Smith masking of GGX, written for cosines so that it stays finite at the horizon."""
    cos_v = np.asarray(cos_v, dtype=float)
    return 2.0 * cos_v / (cos_v + np.sqrt(cos_v**2 + alpha**2 * (1.0 - cos_v**2)))


def conductor_density(alpha, eta, kappa, power=1):
    """Reflected flux density of a bare rough conductor: D G1 G1 F / (4 cos_l), Walter et al. 2007.

    With visible normals a ray that leaves along v carries the weight
    ``F G1(v)``. ``power = 2`` gives the density times that weight, whose
    integral over a cell is the second moment of what one ray deposits in it.

    Returns
    -------
    function (cos_l, cos_v, cos_d, tan2_h) -> density
        ``cos_d`` is l.h, ``tan2_h`` the squared tangent of the polar angle of h.
    """

    def density(cos_l, cos_v, cos_d, tan2_h):
        cos2_h = 1.0 / (1.0 + tan2_h)
        d = alpha**2 / (math.pi * cos2_h**2 * (alpha**2 + tan2_h) ** 2)
        weight = fresnel_conductor(cos_d, complex(eta, kappa)) * smith_g1(cos_v, alpha)
        return d * smith_g1(cos_l, alpha) * weight**power / (4.0 * cos_l)

    return density
