"""Where light goes in a stack of smooth interfaces: adding them one by one from below.

An interface of reflectance R and transmittance T = 1 - R over a medium that passes a of the light at one crossing,
over a stack of reflectance r, gives with A = 1 - a^2 r

    1 - r' = T A / (T + R A),    t' = T a t / (T + R A),    r' = R + T^2 a^2 r / (T + R A),

in which nothing is subtracted: guided light, stacks that lose next to nothing, and those that send next to nothing back
keep their digits. All light has one invariant n sin(theta), so that the sines of all layers are known at once.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...scene import Scene
from . import fresnel

# Of the directions below a coat, between two critical angles.
NODES = 400


@dataclass(frozen=True)
class Energies:
    """Shares of the incident light, per direction and channel.

    Attributes
    ----------
    direct, internal, transmitted, absorbed : ndarray, shape (M, C)
        Reflected by the top interface, and from inside the stack; left below; the rest.
    """

    direct: np.ndarray
    internal: np.ndarray
    transmitted: np.ndarray
    absorbed: np.ndarray


def energies(scene: Scene) -> Energies:
    """Shares of the light of a scene whose dielectrics are all smooth.

    Parameters
    ----------
    scene : Scene
        On a smooth conductor, a Lambertian base, or none.

    Returns
    -------
    Energies
    """
    # The complement of theta keeps the digits of a cosine near grazing.
    cosines = np.sin(np.radians(90.0 - np.asarray(scene.incident.theta_deg)))
    shares = [[_shares(scene, float(cosine), channel) for channel in range(3)] for cosine in cosines]
    return Energies(*np.moveaxis(np.array(shares), -1, 0))


def _shares(scene: Scene, cosine: float, channel: int) -> tuple[float, float, float, float]:
    faces = list(scene.material.interfaces)
    tau = np.array([row[channel] for row in scene.material.tau])
    diffuse = faces.pop() if faces[-1].type == "lambert" else None
    base = faces.pop() if faces and faces[-1].type == "conductor" else None
    index = np.array([1.0, *(face.eta for face in faces)])
    vertical = _vertical(index, index[0] * cosine, 0)
    if base is not None:
        relative = complex(base.eta_rgb[channel], base.kappa_rgb[channel]) / index[-1]
        end = fresnel.conductor(vertical[-1] / index[-1], relative)
        loss, through, inner = added(index, vertical, tau, *end, 0.0)
    elif diffuse is not None:
        # What reaches the base, all of it taken for absorbed at first.
        loss, through, inner = added(index, vertical, tau, 0.0, 1.0, 1.0)
        back, out = _diffuse(tuple(index), tuple(tau))
        rho = diffuse.rho_rgb[channel]
        diffused = through * rho * out / (1.0 - rho * back)
        loss, inner, through = loss - diffused, inner + diffused, 0.0
    else:
        loss, through, inner = added(index, vertical, tau, 0.0, 1.0, 1.0, open_below=True)
    direct = 1.0 - float(_transmitted(index, vertical, 0)) if faces else 0.0
    return direct, float(inner), float(through), float(loss) - float(through)


def added(
    index: np.ndarray,
    vertical: np.ndarray,
    tau: np.ndarray,
    back: float,
    loss: float,
    through: float,
    open_below: bool = False,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Put interfaces and media on what lies below, from the lowest up.

    Parameters
    ----------
    index : ndarray, shape (K + 1,)
        Of the medium above all and below each of K interfaces.
    vertical : ndarray, shape (K + 1, ...)
        Index times cosine of the light in each.
    tau : ndarray
        Optical depth below each interface; below the last one only if something lies there.
    back, loss, through : float
        Reflectance of what lies below, 1 minus it, and its transmittance.
    open_below : bool
        Nothing lies there.

    Returns
    -------
    loss, through, inner : ndarray
        1 - reflectance and transmittance of the whole; its reflectance without that of the top interface.
    """
    back, loss, through = (np.broadcast_to(each, vertical.shape[1:]) for each in (back, loss, through))
    inner = back
    for k in range(len(index) - 2, -1, -1):
        t = _transmitted(index, vertical, k)
        if open_below and k == len(index) - 2:
            back, loss, through, inner = 1.0 - t, t, t, np.zeros_like(t)
            continue
        cosine = np.maximum(vertical[k + 1] / index[k + 1], 1e-300)
        depth = tau[k] / cosine
        once, both = np.exp(-depth), -np.expm1(-2.0 * depth)
        swallowed = both + once * once * loss
        scale = t + (1.0 - t) * swallowed
        # Light that the interface reflects totally never comes below it.
        scale = np.where(t > 0.0, scale, 1.0)
        inner = t * t * once * once * back / scale
        back, loss, through = 1.0 - t + inner, t * swallowed / scale, t * once * through / scale
    return loss, through, inner


def _vertical(index: np.ndarray, known: float | np.ndarray, where: int) -> np.ndarray:
    """Index times cosine in every layer from that in one of them; 0 where no light can be."""
    known = np.asarray(known, float)
    squares = [known**2 + (n - index[where]) * (n + index[where]) for n in index]
    return np.sqrt(np.maximum(np.array(squares), 0.0))


def _transmitted(index: np.ndarray, vertical: np.ndarray, k: int) -> np.ndarray:
    """1 - R of interface k for unpolarised light, from either side."""
    above, below = vertical[k], vertical[k + 1]
    scaled_above, scaled_below = index[k + 1] ** 2 * above, index[k] ** 2 * below
    with np.errstate(invalid="ignore", divide="ignore"):
        s = 4.0 * above * below / (above + below) ** 2
        p = 4.0 * scaled_above * scaled_below / (scaled_above + scaled_below) ** 2
        return np.where(above * below > 0.0, 0.5 * (s + p), 0.0)


@lru_cache
def _diffuse(layers: tuple[float, ...], depths: tuple[float, ...]) -> tuple[float, float]:
    """Shares of Lambertian light from below that a stack sends back down, and up into the air."""
    # The same for all directions of the light.
    index, tau = np.array(layers), np.array(depths)
    n = index[-1]
    critical = sorted({math.sqrt(1.0 - (m / n) ** 2) for m in index[:-1] if m < n})
    edges = [0.0, *critical, 1.0]
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    u, w = 0.5 * (nodes + 1.0), 0.5 * weights
    # Square roots at either end of an interval become smooth.
    smooth, slope = u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u)
    back = out = 0.0
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        mu = low + (high - low) * smooth
        measure = 2.0 * mu * (high - low) * slope * w
        # Seen from below: the order of the layers is reversed, and the medium next to the base comes first.
        upwards = np.concatenate([[n], index[::-1][1:]])
        vertical = _vertical(upwards, n * mu, 0)
        loss, through, _ = added(upwards, vertical, tau[::-1][1:], 0.0, 1.0, 1.0, open_below=True)
        first = np.exp(-(tau[-1] if len(tau) else 0.0) / np.maximum(mu, 1e-300))
        back += float(np.sum(measure * first * first * (1.0 - loss)))
        out += float(np.sum(measure * first * through))
    return back, out
