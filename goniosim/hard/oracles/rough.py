"""Where light goes at one rough interface: single scattering by GGX facets with separable Smith masking.

Slopes of facets, p = alpha tan(t) (cos phi, sin phi), have the density 2 sin(t) cos(t) dt dphi / (2 pi). A direction w
sees them with the weight G1(w) (w.m) / (w_z m_z), m being the normal. Sums over t are by Gauss's rule between the
angles, known in closed form, at which facets turn away from w, send light below the horizon, or begin to reflect all.
"""

import math
from dataclasses import dataclass

import numpy as np

from . import fresnel

# Gauss nodes between two such angles, and in a panel of azimuths.
NODES = 32
_AZIMUTHS = 24


@dataclass(frozen=True)
class Shares:
    """Shares of the incident light.

    Attributes
    ----------
    reflected, transmitted : float
        Left upwards and downwards; what a conductor absorbs counts as nothing.
    lost_reflection, lost_transmission : float
        Sent by a facet, and then masked or on the wrong side.
    absorbed : float
    """

    reflected: float
    transmitted: float
    lost_reflection: float
    lost_transmission: float
    absorbed: float


def cosine_of(theta_deg: float) -> float:
    """Cosine of an angle in degrees, by its complement, which keeps the digits near grazing."""
    return math.sin(math.radians(90.0 - theta_deg))


def masking(height: np.ndarray, alpha: float) -> np.ndarray:
    """Smith's G1 of directions with that cosine; 0 below the horizon."""
    z = np.maximum(height, 0.0)
    return 2.0 * z / np.maximum(z + np.sqrt(z * z + alpha * alpha * (1.0 - z) * (1.0 + z)), 1e-300)


def shares(theta_deg: float, alpha: float, eta: complex, nodes: int = NODES) -> Shares:
    """Where light goes that meets a rough interface from the side of index 1.

    Parameters
    ----------
    theta_deg : float
    alpha : float
        GGX width, more than 0.
    eta : float or complex
        Index of the other side: of a dielectric, or of a conductor if it is complex.
    nodes : int

    Returns
    -------
    Shares
    """
    metal = isinstance(eta, complex)
    wz, wx = cosine_of(theta_deg), math.sin(math.radians(theta_deg))
    real = eta.real
    # A conductor that hardly absorbs does so too, nearly.
    total = math.sqrt((1.0 - real) * (1.0 + real)) if abs(eta) < 1.0 else 0.0
    # Where all facets of an azimuth begin to reflect all.
    begins = math.acos(min(math.sqrt(max(total**2 - wz**2, 0.0)) / max(wx, 1e-300), 1.0))
    phi, d_phi = _azimuths(min(1.0, wz, wz / alpha), begins)
    along = wx * np.cos(phi)
    # What facets send upwards: w_z p^2 + 2 p w_x cos(phi) < w_z.
    root = np.hypot(along, wz)
    upwards = np.where(along > 0.0, wz / (along + root), (root - along) / wz)
    slopes = [upwards, wz / np.maximum(along, 1e-300)]
    # Between steep facets and the others, whatever alpha.
    slopes += [np.full_like(phi, 4.0 * 8.0**-k) for k in range(9) if 4.0 * 8.0**-k > alpha]
    if total:
        slopes += _critical(wz, along, total)
    edges = np.arctan2(np.clip(slopes, 0.0, slopes[1]), alpha)
    edges = np.sort(np.concatenate([np.zeros_like(edges[:1]), edges]), axis=0)

    x, w = np.polynomial.legendre.leggauss(nodes)
    # Square roots at either end of an interval become smooth.
    x = 0.5 * (x + 1.0)
    smooth, slope = x * x * (3.0 - 2.0 * x), 3.0 * w * x * (1.0 - x)
    width = np.diff(edges, axis=0)[..., None]
    t = edges[:-1, :, None] + width * smooth
    sine, cosine = np.sin(t), np.cos(t)
    seen = np.maximum(wz * cosine - along[:, None] * alpha * sine, 0.0)
    visible = 2.0 / (wz + math.hypot(wz, alpha * wx))
    weight = visible * sine * seen * width * slope * d_phi[:, None] / math.pi * 2.0

    length = np.hypot(cosine, alpha * sine)
    facet, mz = np.minimum(seen / length, 1.0), cosine / length
    reflected, rest = (fresnel.conductor if metal else fresnel.dielectric)(facet, eta)
    up = masking(2.0 * facet * mz - wz, alpha)
    absorbed = transmitted = lost = 0.0
    if metal:
        absorbed = float(np.sum(weight * rest))
    else:
        g = np.sqrt(np.maximum(facet * facet + (eta - 1.0) * (eta + 1.0), 0.0))
        below = masking((wz + (g - facet) * mz) / eta, alpha)
        transmitted, lost = (float(np.sum(weight * rest * part)) for part in (below, 1.0 - below))
    kept, masked = (float(np.sum(weight * reflected * part)) for part in (up, 1.0 - up))
    return Shares(kept, transmitted, masked, lost, absorbed)


def reflected_towards(light: np.ndarray, view: np.ndarray, alpha: float, eta: float) -> np.ndarray:
    """Share of the light that a rough dielectric reflects per steradian, into unit vectors above it."""
    half = light + view
    length = np.sqrt((half * half).sum(axis=-1))
    tangent2 = (half[..., 0] ** 2 + half[..., 1] ** 2) / half[..., 2] ** 2
    # In slopes: D dm = P(slope) d slope / cos^4.
    slopes = 1.0 / (math.pi * alpha * alpha * (1.0 + tangent2 / alpha**2) ** 2)
    reflectance, _ = fresnel.dielectric(0.5 * length, eta)
    masked = masking(light[..., 2], alpha) * masking(view[..., 2], alpha)
    return reflectance * masked * slopes * (1.0 + tangent2) ** 2 / (4.0 * light[..., 2])


def _azimuths(finest: float, begins: float) -> tuple[np.ndarray, np.ndarray]:
    """Azimuths from 0 to pi with their weights: the denser towards pi / 2 the more light grazes, with an edge."""
    count = max(2, math.ceil(math.log(10.0 / finest, 3.0)))
    half = 0.5 * math.pi * np.concatenate([[0.0], 3.0 ** np.arange(1.0 - count, 1.0)])
    edges = np.unique([*(0.5 * math.pi - half), *(0.5 * math.pi + half), begins, math.pi - begins])
    x, w = np.polynomial.legendre.leggauss(_AZIMUTHS)
    x = 0.5 * (x + 1.0)
    width = np.diff(edges)
    phi = edges[:-1, None] + np.outer(width, x * x * (3.0 - 2.0 * x))
    return phi.ravel(), np.outer(width, 3.0 * w * x * (1.0 - x)).ravel()


def _critical(wz: float, along: np.ndarray, cosine: float) -> list[np.ndarray]:
    """Slopes of the facets that w meets at that cosine: (w_z - p along)^2 = cosine^2 (1 + p^2)."""
    a, b, c = along**2 - cosine**2, -wz * along, (wz - cosine) * (wz + cosine)
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    q = -(b + np.where(b < 0.0, -root, root))
    with np.errstate(divide="ignore", invalid="ignore"):
        return [np.nan_to_num(slope, posinf=0.0, neginf=0.0) for slope in (q / a, c / q)]
