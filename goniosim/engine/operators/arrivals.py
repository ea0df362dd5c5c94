"""The forward walk that only bins what arrives at one interface.

Light enters for certain. At inner interfaces both branches are followed: a coin would make the dim ones too rare. What
an outermost interface lets through is not followed.
"""

import math

import numpy as np

from ..._jit import kernel, stage
from ...optics.fresnel import dielectric_transmittance, fresnel_conductor, fresnel_dielectric
from ...optics.ggx import smith_g1
from ...optics.lambert import sample_cosine
from ...optics.medium import path_length, transmittance
from ...optics.random import derive_key, uniform
from ..lattice import DIMENSIONS, STEPS, coordinate
from ..stages import LAMBERT, ROUGH_CONDUCTOR, ROUGH_DIELECTRIC, SMOOTH_CONDUCTOR, SMOOTH_DIELECTRIC
from ..stages.lambert import RHO
from ..stages.smooth_conductor import ETA, KAPPA
from .facets import meet_facet
from .nodes import deposit

# A ray that would be fainter than this, had its facets been drawn from plain distributions, plays Russian roulette.
FAINT = 0.01
# Rays of one path that may wait. If there is no room for both branches, a coin with fair weights chooses one.
WAITING = 64
# Interfaces that a path meets at most, all its branches together.
MOST_EVENTS = 10_000

# A ray that waits: its view of the next interface, the ratio of densities, where and how it arrives, its order.
X, Y, Z, RATIO, INTERFACE, DOWNWARDS, ORDER, WEIGHT = range(8)
# Numbers that an event draws: facet or direction, roulette of the two branches, coin.
_DRAWS = 6
_LEAST_COSINE = 1e-9


def waiting_rays(plan, room=WAITING):
    """An array for the rays of one path that wait."""
    return np.empty((room, WEIGHT + plan.n_distinct))


@kernel
def bin_arrivals(stack, light, target, first, last, shifts, paths_key, waiting, bins):
    """Trace paths ``first`` to ``last - 1`` of a replicate and spread what arrives over the nodes.

    Parameters
    ----------
    stack : tuple
        Tables of `plan.Plan`: kinds, alphas, etas, spectral, taus, absorbs.
    light : ndarray, shape (3,)
    target : ndarray of int64, shape (4,)
        The interface; 1 if light arrives at it from below; number of the order that a path has if it leaves without
        another event on the top interface, less its order on arrival; every ``stride``-th node is used.
    shifts : ndarray, shape (DIMENSIONS,)
        Of the replicate's lattice.
    paths_key : uint64
    waiting : ndarray
        As `waiting_rays` makes it.
    bins : ndarray, shape (slots, azimuths, polar angles, channels)
        Sums of weights; added to.

    Returns
    -------
    int
        Ray-interface events.
    """
    kinds, alphas, etas, spectral, taus, absorbs = stack
    channels = bins.shape[3]
    weight = np.empty(channels)
    events = 0
    for number in range(first, last):
        key = derive_key(paths_key, number)
        n = _enter(light, alphas[0], etas[0], shifts, number, waiting)
        events += 1
        met = 0
        while n > 0 and met < MOST_EVENTS:
            n -= 1
            ray = waiting[n]
            k = int(ray[INTERFACE])
            downwards = ray[DOWNWARDS] > 0.0
            x = ray[X]
            y = ray[Y]
            z = max(ray[Z], _LEAST_COSINE)
            ratio = ray[RATIO]
            order = ray[ORDER]
            for c in range(channels):
                weight[c] = ray[WEIGHT + c]
            medium = k - 1 if downwards else k
            if absorbs[medium]:
                path = path_length(z)
                for c in range(channels):
                    weight[c] *= transmittance(taus[medium, c], path)
            if k == target[0] and downwards == (target[1] == 0):
                slot = min(max(int(order) + target[2], 0), bins.shape[0] - 1)
                deposit(x, y, z, weight, ratio, target[3], bins[slot])
            counter = met * _DRAWS
            u1 = uniform(key, counter)
            u2 = uniform(key, counter + 1)
            u3 = uniform(key, counter + 2)
            if met == 0:
                u1 = coordinate(shifts[3], number, STEPS[3])
                u2 = coordinate(shifts[4], number, STEPS[4])
                u3 = coordinate(shifts[5], number, STEPS[5])
            met += 1
            n = _scatter(
                x, y, z, weight, ratio, order, k, downwards, kinds, alphas, etas, spectral, u1, u2, u3, key, counter + 3,
                waiting, n,
            )  # fmt: skip
        events += met
    return events


@stage
def _enter(light, alpha, eta, shifts, number, waiting):
    u1 = coordinate(shifts[0], number, STEPS[0])
    u2 = coordinate(shifts[1], number, STEPS[1])
    u3 = coordinate(shifts[2], number, STEPS[2])
    x = light[0]
    z = max(light[2], _LEAST_COSINE)
    mx, my, mz, ratio = meet_facet(x, 0.0, z, alpha, u1, u2, u3)
    cosine = min(1.0, max(0.0, x * mx + z * mz))
    _, cos_t = fresnel_dielectric(cosine, eta)
    along = cosine / eta - cos_t
    ray = waiting[0]
    ray[X] = x / eta - along * mx
    ray[Y] = -along * my
    ray[Z] = z / eta - along * mz
    ray[RATIO] = ratio
    ray[INTERFACE] = 1.0
    ray[DOWNWARDS] = 1.0
    ray[ORDER] = 1.0
    gain = dielectric_transmittance(cosine, eta) * smith_g1(ray[Z], alpha)
    for c in range(ray.shape[0] - WEIGHT):
        ray[WEIGHT + c] = gain
    return 1 if gain > 0.0 else 0


@stage
def _scatter(
    x, y, z, weight, ratio, order, k, downwards, kinds, alphas, etas, spectral, u1, u2, u3, key, counter, waiting, n
):  # fmt: skip
    """Put what leaves an interface within the stack on the pile of rays that wait; returns the height of the pile."""
    kind = kinds[k]
    dielectric = kind in (ROUGH_DIELECTRIC, SMOOTH_DIELECTRIC)
    alpha = alphas[k]
    order += 1.0 if k == 0 else 0.0
    if kind == LAMBERT:
        ox, oy, oz = sample_cosine(u1, u2)
        n = _keep(
            ox, oy, oz, 1.0, 0.0, weight, kind, spectral[k], ratio, order, k, downwards, False, uniform(key, counter), waiting, n
        )  # fmt: skip
        return n
    eta = etas[k] if downwards else 1.0 / etas[k]
    mx, my, mz, facet_ratio = meet_facet(x, y, z, alpha, u1, u2, u3)
    ratio *= facet_ratio
    cosine = min(1.0, max(0.0, x * mx + y * my + z * mz))
    reflectance, cos_t = fresnel_dielectric(cosine, eta)
    inner = dielectric and 0 < k < kinds.shape[0] - 1
    both = n + 2 <= waiting.shape[0]
    reflects = (not inner) or both or uniform(key, counter + 2) < reflectance
    if reflects:
        along = 2.0 * cosine
        oz = along * mz - z
        gain = smith_g1(oz, alpha) * ((reflectance if both or not inner else 1.0) if dielectric else 1.0)
        n = _keep(
            x - along * mx, y - along * my, oz, gain, cosine, weight, kind, spectral[k], ratio, order, k, downwards, False,
            uniform(key, counter), waiting, n,
        )  # fmt: skip
    if inner and (both or not reflects):
        along = cosine / eta - cos_t
        oz = z / eta - along * mz
        gain = smith_g1(oz, alpha) * (1.0 - reflectance if both else 1.0)
        n = _keep(
            x / eta - along * mx, y / eta - along * my, oz, gain, cosine, weight, kind, spectral[k], ratio, order, k, downwards,
            True, uniform(key, counter + 1), waiting, n,
        )  # fmt: skip
    return n


@stage
def _keep(
    x, y, z, gain, cosine, weight, kind, spectral, ratio, order, k, downwards, through, u, waiting, n
):  # fmt: skip
    """One ray onto the pile, unless it ended or lost at roulette."""
    if z <= 0.0 or gain <= 0.0:
        return n
    ray = waiting[n]
    brightest = 0.0
    for c in range(weight.shape[0]):
        f = gain * weight[c]
        if kind == LAMBERT:
            f *= spectral[RHO, c]
        elif kind in (ROUGH_CONDUCTOR, SMOOTH_CONDUCTOR):
            f *= fresnel_conductor(cosine, spectral[ETA, c], spectral[KAPPA, c])
        ray[WEIGHT + c] = f
        brightest = max(brightest, f)
    survival = min(1.0, brightest / FAINT)
    if u >= survival:
        return n
    for c in range(weight.shape[0]):
        ray[WEIGHT + c] /= survival
    down = downwards == through
    ray[X] = x
    ray[Y] = y
    ray[Z] = z
    ray[RATIO] = ratio
    ray[INTERFACE] = k + 1.0 if down else k - 1.0
    ray[DOWNWARDS] = 1.0 if down else -1.0
    ray[ORDER] = order
    return n + 1
