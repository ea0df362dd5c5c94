"""The forward walk that only bins what arrives at one interface.

Light enters for certain. At inner interfaces both branches are followed: a coin would make the dim ones too rare. What
an outermost interface lets through is not followed.
"""

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

# Children of a replicate's key: the shifts of its lattice, its paths.
SHIFTS, PATHS = 0, 1
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
def bin_arrivals(stack, light, target, first, last, key, waiting, bins):
    """Trace paths ``first`` to ``last - 1`` of a replicate and spread what arrives over the nodes.

    Parameters
    ----------
    stack : tuple
        Tables of `plan.Plan`: kinds, alphas, etas, spectral, taus, absorbs.
    light : ndarray, shape (3,)
    target : ndarray of int64, shape (4,)
        The interface; 1 if light arrives at it from below; number of the order that a path has if it leaves without
        another event on the top interface, less its order on arrival; every ``stride``-th node is used.
    key : uint64
        Of the replicate.
    waiting : ndarray
        As `waiting_rays` makes it.
    bins : ndarray, shape (slots, azimuths, polar angles, channels)
        Sums of weights; added to.

    Returns
    -------
    int
        Ray-interface events.
    """
    ray = np.empty(waiting.shape[1])
    shifts = np.empty(DIMENSIONS)
    shifts_key = derive_key(key, SHIFTS)
    for dimension in range(DIMENSIONS):
        shifts[dimension] = uniform(shifts_key, dimension)
    paths_key = derive_key(key, PATHS)
    events = 0
    for number in range(first, last):
        path_key = derive_key(paths_key, number)
        n = _enter(light, stack, shifts, number, waiting)
        met = 0
        while n > 0 and met < MOST_EVENTS:
            n -= 1
            for field in range(ray.shape[0]):
                ray[field] = waiting[n, field]
            _arrive(ray, stack, target, bins)
            counter = met * _DRAWS
            u1 = uniform(path_key, counter)
            u2 = uniform(path_key, counter + 1)
            u3 = uniform(path_key, counter + 2)
            if met == 0:
                u1 = coordinate(shifts[3], number, STEPS[3])
                u2 = coordinate(shifts[4], number, STEPS[4])
                u3 = coordinate(shifts[5], number, STEPS[5])
            met += 1
            n = _scatter(ray, stack, u1, u2, u3, path_key, counter + 3, waiting, n)
        events += met + 1
    return events


@stage
def _enter(light, stack, shifts, number, waiting):
    """Put the ray that has entered the stack on the pile; returns the height of the pile."""
    _, alphas, etas, _, _, _ = stack
    alpha = alphas[0]
    eta = etas[0]
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
    for field in range(WEIGHT, ray.shape[0]):
        ray[field] = gain
    return 1 if gain > 0.0 else 0


@stage
def _arrive(ray, stack, target, bins):
    """Absorb what the way to the interface costs, and count the ray if it is the one in question."""
    _, _, _, _, taus, absorbs = stack
    k = int(ray[INTERFACE])
    downwards = ray[DOWNWARDS] > 0.0
    ray[Z] = max(ray[Z], _LEAST_COSINE)
    medium = k - 1 if downwards else k
    if absorbs[medium]:
        path = path_length(ray[Z])
        for c in range(bins.shape[3]):
            ray[WEIGHT + c] *= transmittance(taus[medium, c], path)
    if k == target[0] and downwards == (target[1] == 0):
        slot = min(int(ray[ORDER]) + target[2], bins.shape[0] - 1)
        deposit(ray[X], ray[Y], ray[Z], ray[WEIGHT:], ray[RATIO], target[3], bins[slot])
    ray[ORDER] += 1.0 if k == 0 else 0.0


@stage
def _scatter(ray, stack, u1, u2, u3, key, counter, waiting, n):
    """Put what an interface sends back into the stack on the pile; returns the height of the pile."""
    kinds, alphas, etas, spectral, _, _ = stack
    k = int(ray[INTERFACE])
    kind = kinds[k]
    u = uniform(key, counter)
    if kind == LAMBERT:
        x, y, z = sample_cosine(u1, u2)
        return _keep(ray, x, y, z, 1.0, 0.0, False, kind, spectral[k], u, waiting, n)
    x = ray[X]
    y = ray[Y]
    z = ray[Z]
    alpha = alphas[k]
    eta = etas[k] if ray[DOWNWARDS] > 0.0 else 1.0 / etas[k]
    mx, my, mz, ratio = meet_facet(x, y, z, alpha, u1, u2, u3)
    ray[RATIO] *= ratio
    cosine = min(1.0, max(0.0, x * mx + y * my + z * mz))
    reflectance, cos_t = fresnel_dielectric(cosine, eta)
    passes = 1.0 - reflectance
    dielectric = kind in (ROUGH_DIELECTRIC, SMOOTH_DIELECTRIC)
    # What an outermost interface lets through is not followed, and a conductor's reflectance is that of each channel.
    inner = dielectric and 0 < k < kinds.shape[0] - 1
    reflectance = reflectance if dielectric else 1.0
    if inner and n + 2 > waiting.shape[0]:
        reflectance = 1.0 if uniform(key, counter + 2) < reflectance else 0.0
        passes = 1.0 - reflectance
    along = 2.0 * cosine
    oz = along * mz - z
    gain = reflectance * smith_g1(oz, alpha)
    n = _keep(ray, x - along * mx, y - along * my, oz, gain, cosine, False, kind, spectral[k], u, waiting, n)
    if inner:
        along = cosine / eta - cos_t
        oz = z / eta - along * mz
        gain = passes * smith_g1(oz, alpha)
        ox = x / eta - along * mx
        oy = y / eta - along * my
        u = uniform(key, counter + 1)
        n = _keep(ray, ox, oy, oz, gain, cosine, True, kind, spectral[k], u, waiting, n)
    return n


@stage
def _keep(ray, x, y, z, gain, cosine, through, kind, spectral, u, waiting, n):
    """One ray onto the pile, unless it ended or lost at roulette; returns the height of the pile."""
    if z <= 0.0 or gain <= 0.0:
        return n
    kept = waiting[n]
    brightest = 0.0
    for c in range(spectral.shape[1]):
        weight = gain * ray[WEIGHT + c]
        if kind == LAMBERT:
            weight *= spectral[RHO, c]
        elif kind in (ROUGH_CONDUCTOR, SMOOTH_CONDUCTOR):
            weight *= fresnel_conductor(cosine, spectral[ETA, c], spectral[KAPPA, c])
        kept[WEIGHT + c] = weight
        brightest = max(brightest, weight)
    survival = min(1.0, brightest / FAINT)
    if u >= survival:
        return n
    for c in range(spectral.shape[1]):
        kept[WEIGHT + c] /= survival
    down = (ray[DOWNWARDS] > 0.0) == through
    kept[X] = x
    kept[Y] = y
    kept[Z] = z
    kept[RATIO] = ray[RATIO]
    kept[INTERFACE] = ray[INTERFACE] + (1.0 if down else -1.0)
    kept[DOWNWARDS] = 1.0 if down else -1.0
    kept[ORDER] = ray[ORDER]
    return n + 1
