"""A rough dielectric over a Lambertian base, in closed form but for integrals over facets (Saunderson).

With A(theta) the share of light that passes the interface from above, and R the share of Lambertian light from below
that it sends back, a unit of light leaves as A(l) rho / (1 - rho R) times A(v) cos(v) / (pi n^2) per steradian: what
enters, all returns to a base that forgets them, and, by reciprocity, what leaves. Nothing here uses goniosim.
"""

import math
from functools import cache

import numpy as np

from .closed_forms import coin_of, smith_g1

_POINTS = 150
_ANGLES = 192
# Relative changes by which slopes are found.
_STEP = 1e-2


def _facets(cos_w, alpha):
    """Cosines at facets seen from w, heights of their normals, and their shares; midpoints in azimuth and slope."""
    half = (np.arange(_POINTS) + 0.5) / _POINTS
    phi, w = math.pi * half[:, None], half[None, :]
    # D cos(theta_h) is uniform in u = 1 - w^2 with tan^2 = alpha^2 u / (1 - u): few slopes are steep.
    tan = alpha * np.sqrt(1.0 - w * w) / w
    cos_h = 1.0 / np.sqrt(1.0 + tan * tan)
    cosine = cos_h * (cos_w + math.sqrt(1.0 - cos_w**2) * tan * np.cos(phi))
    share = np.maximum(cosine, 0.0) / cos_h * 2.0 * w * (float(smith_g1(cos_w, alpha)) / cos_w)
    return np.clip(cosine, 0.0, 1.0), cos_h + 0.0 * phi, share / _POINTS**2


def passed(cos_w, alpha, n, coin=1.0):
    """Share of light from w that the interface refracts, of relative index ``n``."""
    cosine, cos_h, share = _facets(cos_w, alpha)
    beyond = np.sqrt(np.maximum(n * n - 1.0 + cosine**2, 0.0))
    height = (cos_w - (cosine - beyond) * cos_h) / n
    visible = np.where(height > 0.0, smith_g1(np.maximum(height, 1e-300), alpha), 0.0)
    return float((share * (1.0 - coin_of(cosine, n, coin)) * visible).sum())


def sent_back(cos_w, alpha, n, coin=1.0):
    """Share of light from w that the interface reflects."""
    cosine, cos_h, share = _facets(cos_w, alpha)
    height = 2.0 * cosine * cos_h - cos_w
    visible = np.where(height > 0.0, smith_g1(np.maximum(height, 1e-300), alpha), 0.0)
    return float((share * coin_of(cosine, n, coin) * visible).sum())


def rough_plastic_rows(theta, alpha, n, rho, rows, coin=1.0):
    """Energy in each of ``rows`` equal steps of theta_v, from all azimuths; ndarray."""
    x, weights = np.polynomial.legendre.leggauss(_ANGLES)
    mu, weights = 0.5 * (x + 1.0), 0.5 * weights
    back = sum(2.0 * m * w * sent_back(m, alpha, 1.0 / n, coin) for m, w in zip(mu, weights, strict=True))
    radiance = passed(math.cos(math.radians(theta)), alpha, n, coin) * rho / (1.0 - rho * back) / math.pi
    x, weights = np.polynomial.legendre.leggauss(max(4, _ANGLES // rows))
    step = 0.5 * math.pi / rows
    angles = (np.arange(rows)[:, None] + 0.5 * (x + 1.0)) * step
    leaving = [[passed(math.cos(a), alpha, n, coin) * math.sin(a) * math.cos(a) for a in row] for row in angles]
    return radiance * 2.0 * math.pi / n**2 * (np.array(leaving) * (0.5 * step * weights)).sum(axis=1)


@cache
def rough_plastic_laws(theta, alpha, n, rho, rows):
    """Energies of the rows, and their slopes by the logarithms of coin and width."""
    mean = rough_plastic_rows(theta, alpha, n, rho, rows)
    coin = (rough_plastic_rows(theta, alpha, n, rho, rows, 1.0 - _STEP) - mean) / -_STEP
    width = (rough_plastic_rows(theta, alpha * (1.0 + _STEP), n, rho, rows) - mean) / _STEP
    return mean, coin, width
