"""Closed forms of layered materials, and their integrals over the cells of a slice.

Nothing here uses goniosim. Directions point away from the surface, the light
stands at phi = 0, and densities are *flux densities*: the fraction of the
incident flux that leaves per steradian, which is the BSDF times cos(theta_v).
They take (sin_l, cos_l, x, y, z): the light is (sin_l, 0, cos_l), and (x, y, z)
leads to the viewer, where z >= 0 is the height above the horizon for reflection
and the depth below it for transmission.
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
    above = quad(lambda t: 2.0 * t * integrand(critical + t * t), start, width, epsabs=1e-13, epsrel=1e-12, limit=200)[
        0
    ]
    return below + above


def plastic_density(n, rho, tau=0.0, power=1):
    """Internal flux density of a smooth coat over a Lambertian base.

    ``power = 2`` gives the second moment instead: every interaction multiplies
    a ray's weight by rho or by exp(-tau / cos), so the square of the weight
    follows the same law with rho^2 and 2 tau where these are weights, while
    the coat's reflectance, a probability, stays as it is.
    """
    rho, tau = rho**power, tau * power
    bounce = rho / (1.0 - rho * internal_reflectance(n, tau))

    def density(sin_l, cos_l, x, y, z):
        in_l, in_v = refracted_cosine(cos_l, n), refracted_cosine(z, n)
        crossing = (1.0 - fresnel_dielectric(cos_l, n)) * (1.0 - fresnel_dielectric(z, n))
        return crossing * np.exp(-tau / in_l - tau / in_v) * bounce * z / (math.pi * n * n)

    return density


def plastic_albedo(cos_l, n, rho, tau=0.0):
    """Internal albedo of a smooth coat over a Lambertian base."""
    density = plastic_density(n, rho, tau)

    def ring(z):
        return 2.0 * math.pi * float(density(None, cos_l, None, None, z))

    return quad(ring, 0.0, 1.0, epsabs=1e-13, epsrel=1e-11)[0]


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


# --- one rough interface ----------------------------------------------------------------------


def ggx(tan2_h, alpha):
    """Density of facet normals, for the squared tangent of the angle between normal and surface."""
    return alpha**2 * (1.0 + tan2_h) ** 2 / (math.pi * (alpha**2 + tan2_h) ** 2)


def smith_g1(cos_v, alpha):
    """Smith masking of GGX, written for cosines so that it stays finite at the horizon."""
    cos_v = np.asarray(cos_v, dtype=float)
    return 2.0 * cos_v / (cos_v + np.sqrt(cos_v**2 + alpha**2 * (1.0 - cos_v**2)))


def coin_of(cos_i, n, coin):
    """Reflectance of a dielectric, times ``coin`` where it is not total."""
    reflectance = fresnel_dielectric(cos_i, n)
    return np.where(reflectance < 1.0, np.minimum(1.0, coin * reflectance), 1.0)


def reflection_density(alpha, n, power=1, coin=1.0):
    """Direct flux density of one rough interface: D G1 G1 F / (4 cos_l), Walter et al. 2007.

    ``n`` is the relative index, real or complex. With visible normals, a ray
    reflected by a conductor carries the weight F G1(v); ``power = 2`` gives the
    density times that weight, whose integral over a cell is the second moment
    of what one ray deposits there. At a dielectric F is a probability and the
    weight is G1(v) alone, and ``coin`` a factor on it.
    """

    def density(sin_l, cos_l, x, y, z):
        hx, hy, hz = sin_l + x, y, cos_l + z
        in_plane2 = hx * hx + hy * hy
        # |l + v| = 2 l.h for unit vectors
        cos_d = np.minimum(1.0, 0.5 * np.sqrt(in_plane2 + hz * hz))
        visible = smith_g1(z, alpha)
        if np.iscomplexobj(n):
            fresnel = fresnel_conductor(cos_d, n)
            moment = (fresnel * visible) ** power
        else:
            moment = coin_of(cos_d, n, coin) * visible**power
        return ggx(in_plane2 / (hz * hz), alpha) * smith_g1(cos_l, alpha) * moment / (4.0 * cos_l)

    return density


def transmission_density(alpha, n, power=1, coin=1.0):
    """Flux density through one rough dielectric interface of relative index ``n`` (not 1).

    Eq. 21 of Walter et al. 2007 times the cosine, as flux: without the factor
    that turns it into radiance. ``power`` and ``coin`` as in `reflection_density`.
    """

    def density(sin_l, cos_l, x, y, z):
        # l + n v is normal to the facet; it points into the medium of lower index.
        hx, hy, hz = sin_l + n * x, n * y, cos_l - n * z
        length2 = hx * hx + hy * hy + hz * hz
        upwards = np.sign(hz) / np.sqrt(length2)
        cos_i = (sin_l * hx + cos_l * hz) * upwards
        cos_o = -(x * hx + y * hy - z * hz) * upwards
        possible = (cos_i > 0.0) & (cos_o > 0.0)
        cos_i, cos_o = np.where(possible, cos_i, 1.0), np.where(possible, cos_o, 0.0)
        jacobian = n * n * cos_o / length2
        through = 1.0 - coin_of(np.minimum(cos_i, 1.0), n, coin)
        tan2_h = (hx * hx + hy * hy) / np.where(possible, hz * hz, 1.0)
        lit = smith_g1(cos_l, alpha) * cos_i / cos_l
        return ggx(tan2_h, alpha) * lit * jacobian * through * smith_g1(z, alpha) ** power

    # Facets are upright there, and beyond there are none.
    density.jump = lambda cos_l: cos_l / n
    return density
