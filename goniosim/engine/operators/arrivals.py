"""The forward walk that only bins what arrives at one interface.

Light enters for certain. At inner interfaces both branches are followed: a coin would make the dim ones too rare. What
an outermost interface lets through is not followed. As in `goniosim.engine.walk`, every interface has two queues, and
batches of the fullest one meet it in loops without branches. Every ray carries the key of its random numbers, so that
paths do not depend on what waits beside them.
"""

import numpy as np

from ..._jit import kernel, stage
from ...optics.random import derive_key, uniform
from ..lattice import DIMENSIONS
from ..sorting import move, sort
from ..stages import LAMBERT, ROUGH_CONDUCTOR, SMOOTH_CONDUCTOR
from ..stages.lambert import RHO
from ..stages.smooth_conductor import ETA, KAPPA
from ..walk import ABOVE, BELOW, MAX_ROUNDS, fullest
from .bins import clear, deposit
from .branches import absorb, colour, enter, find_brightest, forget, reflect, refract, scale, share_out
from .facets import draw, draw_lattice, meet_facets
from .nodes import stencils
from .rays import (
    AROUND,
    BRIGHTEST,
    COSINE,
    COSINE_BEYOND,
    EVENTS,
    FACET_X,
    FACET_Y,
    FACET_Z,
    GAIN,
    KEY,
    LAUNCHED,
    MOVED,
    NEXT_KEY,
    NEXT_X,
    NEXT_Y,
    NEXT_Z,
    POLAR,
    RATIO,
    REFLECTANCE,
    REPLICATE,
    ROUNDS,
    SLOT,
    WEIGHT,
    X,
    Y,
    Z,
)

# Children of a replicate's key: the shifts of its lattice, its paths.
SHIFTS, PATHS = 0, 1
# A ray that would be fainter than this, had its facets been drawn from plain distributions, plays Russian roulette.
FAINT = 0.01
# Numbers that a ray draws at an event besides those of `facets`: roulettes of the two branches, a coin; and the keys of
# the branches.
_ROULETTE, _COIN, _BRANCH = 3, 5, 6
_LEAST_COSINE = 1e-9
# Dimensions of the lattice that entry takes; the first event inside takes the rest.
_ENTRY = DIMENSIONS // 2


@kernel
def bin_arrivals(stack, light, target, size, keys, crowd, budget, space, bins):
    """Advance the walk of some replicates by about ``budget`` events; returns whether it is finished.

    Parameters
    ----------
    stack : tuple
        Tables of `plan.Plan`: kinds, alphas, etas, spectral, taus, absorbs.
    light : ndarray, shape (3,)
    target : ndarray of int64, shape (3,)
        The interface; 1 if light arrives at it from below; number of the order that a path has if it leaves without
        another event on the top interface, less its order on arrival.
    size : int
        Paths of a replicate.
    keys : ndarray of uint64
        Of the replicates.
    crowd : int
        Rays in the fullest queue, above which an inner interface does not branch.
    budget : int
        Events after which to return to the caller, who looks at signals.
    space : tuple
        As `rays.workspace` makes it; its first two arrays are cleared before a walk.
    bins : ndarray, shape (replicates * slots, azimuths, polar angles * channels)
        Overwritten: sums of weights.
    """
    kinds, alphas, etas, spectral, taus, absorbs = stack
    state, filled, queues, batch, scratch, steps, lists, nodes = space
    last = kinds.shape[0] - 1
    channels = taus.shape[1]
    distances = bins.shape[1] // 2
    slots = bins.shape[0] // keys.shape[0]
    most = steps.shape[0]
    stop_at = state[EVENTS] + budget
    while state[EVENTS] < stop_at:
        q = fullest(filled)
        crowded = filled[q] > crowd
        if state[LAUNCHED] == size and state[REPLICATE] < keys.shape[0]:
            state[REPLICATE] += 1
            state[LAUNCHED] = 0
        starts = filled[q] < most and state[REPLICATE] < keys.shape[0]
        if starts:
            replicate = state[REPLICATE]
            key = keys[replicate]
            number = state[LAUNCHED]
            if number == 0:
                clear(bins[replicate * slots : (replicate + 1) * slots])
            n = min(most, size - number)
            state[LAUNCHED] += n
            state[EVENTS] += n
            _launch(batch, n, light, number, replicate * slots + min(1 + target[2], slots - 1), scratch[NEXT_KEY])
            draw_lattice(scratch[NEXT_KEY], n, alphas[0], derive_key(key, SHIFTS), 0, scratch)
            meet_facets(batch, n, alphas[0], scratch)
            enter(light, n, alphas[0], etas[0], scratch)
            n = _close_up(batch, n, channels, scratch, steps, lists)
            q = 2 + ABOVE
        elif filled[q] == 0:
            return True
        else:
            if state[REPLICATE] == keys.shape[0]:
                state[ROUNDS] += 1
                if state[ROUNDS] > MAX_ROUNDS * filled.shape[0]:
                    # As in the analog walk: what is still inside is lost.
                    return True
            n = min(most, filled[q])
            filled[q] -= n
            _pop(queues[q], filled[q], batch, n)

        k = q // 2
        side = q % 2
        kind = kinds[k]
        eta = etas[k] if side == ABOVE else 1.0 / etas[k]
        medium = k - 1 if side == ABOVE else k
        state[EVENTS] += n
        _lift(batch[Z], n)
        if absorbs[medium]:
            absorb(batch, n, taus[medium], scratch)
        if k == target[0] and side == target[1]:
            polar, around = scratch[POLAR : POLAR + 4], scratch[AROUND : AROUND + 4]
            stencils(batch[X], batch[Y], batch[Z], batch[RATIO], n, distances, polar, around, nodes)
            deposit(batch[WEIGHT:], batch[SLOT], n, polar, around, nodes, bins)
        if slots > 1 and k == 0:
            _count_order(batch[SLOT], n, slots)

        if starts:
            draw_lattice(batch[KEY], n, alphas[k], derive_key(key, SHIFTS), _ENTRY, scratch)
            _derive_keys(batch[KEY], n, derive_key(key, PATHS))
        else:
            draw(batch, n, alphas[k], scratch)
        inner = False
        if kind == LAMBERT:
            for c in range(channels):
                scale(batch[WEIGHT + c], n, spectral[k, RHO, c])
            cosines, sines, heights = scratch[FACET_X], scratch[FACET_Y], scratch[FACET_Z]
            forget(n, cosines, sines, heights, scratch[NEXT_X], scratch[NEXT_Y], scratch[NEXT_Z], scratch[GAIN])
        else:
            meet_facets(batch, n, alphas[k], scratch)
            if kind in (ROUGH_CONDUCTOR, SMOOTH_CONDUCTOR):
                for c in range(channels):
                    colour(batch[WEIGHT + c], n, scratch[COSINE], spectral[k, ETA, c], spectral[k, KAPPA, c])
                _fill(scratch[REFLECTANCE], n, 1.0)
            else:
                # What an outermost interface lets through is not followed.
                inner = 0 < k < last
                share_out(scratch[COSINE], n, eta, scratch[REFLECTANCE], scratch[COSINE_BEYOND])
                if inner and crowded:
                    _toss(batch[KEY], n, scratch[REFLECTANCE])
            _turn_back(batch, n, alphas[k], scratch)
        find_brightest(batch, n, channels, scratch[BRIGHTEST])
        for through in range(2 if inner else 1):
            if through == 1:
                _go_through(batch, n, alphas[k], eta, scratch)
            up = (through == 1) == (side == BELOW)
            q = 2 * (k - 1) + BELOW if up else 2 * (k + 1) + ABOVE
            _branch(batch[KEY], n, through, scratch[BRIGHTEST], scratch[GAIN], scratch[NEXT_KEY])
            first = Z if kinds[q // 2] == LAMBERT else X
            filled[q] += _push(batch, n, channels, scratch, steps, lists, queues[q], filled[q], first)
    return False


@stage
def _launch(batch, n, light, number, slot, numbers):
    for field in range(SLOT + 1):
        value = light[field] if field <= Z else (1.0 if field == RATIO else slot)
        row = batch[field]
        for i in range(n):
            row[i] = value
    batch[Z, :n] = max(light[2], _LEAST_COSINE)
    for i in range(n):
        numbers[i] = number + i


@stage
def _close_up(batch, n, channels, scratch, steps, lists):
    """Keep the rays that have entered, with the numbers of their paths for keys; returns how many those are."""
    gain = scratch[GAIN]
    _, m = sort(gain, gain, n, steps, lists[0], lists[1])
    move(scratch[NEXT_X], n, lists[1], m, batch[X], 0)
    move(scratch[NEXT_Y], n, lists[1], m, batch[Y], 0)
    move(scratch[NEXT_Z], n, lists[1], m, batch[Z], 0)
    move(scratch[NEXT_KEY], n, lists[1], m, batch[KEY], 0)
    ratio = batch[RATIO]
    moved = scratch[MOVED]
    move(ratio, n, lists[1], m, moved, 0)
    for i in range(m):
        ratio[i] = moved[i]
    for c in range(channels):
        move(gain, n, lists[1], m, batch[WEIGHT + c], 0)
    return m


@stage
def _pop(queue, start, batch, n):
    for field in range(queue.shape[0]):
        source = queue[field][start : start + n]
        row = batch[field]
        for i in range(n):
            row[i] = source[i]


@stage
def _lift(z, n):
    for i in range(n):
        z[i] = max(z[i], _LEAST_COSINE)


@stage
def _fill(row, n, value):
    for i in range(n):
        row[i] = value


@stage
def _count_order(slot, n, slots):
    for i in range(n):
        number = int(slot[i]) + 1
        slot[i] = number if number % slots > 0 else number - 1


@stage
def _derive_keys(numbers, n, paths_key):
    keys = numbers.view(np.uint64)
    for i in range(n):
        keys[i] = derive_key(paths_key, np.uint64(numbers[i]))


@stage
def _toss(row, n, reflectance):
    keys = row.view(np.uint64)
    for i in range(n):
        reflectance[i] = 1.0 if uniform(keys[i], _COIN) < reflectance[i] else 0.0


@stage
def _turn_back(batch, n, alpha, scratch):
    reflect(
        batch[X],
        batch[Y],
        batch[Z],
        n,
        alpha,
        scratch[FACET_X],
        scratch[FACET_Y],
        scratch[FACET_Z],
        scratch[COSINE],
        scratch[REFLECTANCE],
        scratch[NEXT_X],
        scratch[NEXT_Y],
        scratch[NEXT_Z],
        scratch[GAIN],
    )


@stage
def _go_through(batch, n, alpha, eta, scratch):
    refract(
        batch[X],
        batch[Y],
        batch[Z],
        n,
        alpha,
        eta,
        scratch[FACET_X],
        scratch[FACET_Y],
        scratch[FACET_Z],
        scratch[COSINE],
        scratch[REFLECTANCE],
        scratch[COSINE_BEYOND],
        scratch[NEXT_X],
        scratch[NEXT_Y],
        scratch[NEXT_Z],
        scratch[GAIN],
    )


@stage
def _branch(row, n, through, brightest, gain, next_row):
    """Roulette on a branch, and the keys of its rays."""
    keys = row.view(np.uint64)
    next_keys = next_row.view(np.uint64)
    for i in range(n):
        bright = brightest[i] * (1.0 / FAINT)
        wins = uniform(keys[i], _ROULETTE + through) < gain[i] * bright
        # Who is not faint wins, and keeps the weight.
        gain[i] = max(gain[i], 1.0 / max(bright, 1e-300)) if wins else 0.0
    for i in range(n):
        next_keys[i] = derive_key(keys[i], _BRANCH + through)


@stage
def _push(batch, n, channels, scratch, steps, lists, queue, start, first):
    """Append a branch to a queue; returns how many rays that are. Fields before ``first`` do not matter there."""
    gain, moved, places = scratch[GAIN], scratch[MOVED], lists[1]
    _, m = sort(gain, gain, n, steps, lists[0], places)
    if first == X:
        move(scratch[NEXT_X], n, places, m, queue[X], start)
        move(scratch[NEXT_Y], n, places, m, queue[Y], start)
    move(scratch[NEXT_Z], n, places, m, queue[Z], start)
    move(batch[RATIO], n, places, m, queue[RATIO], start)
    move(scratch[NEXT_KEY], n, places, m, queue[KEY], start)
    move(batch[SLOT], n, places, m, queue[SLOT], start)
    for c in range(channels):
        weight = batch[WEIGHT + c]
        for i in range(n):
            moved[i] = weight[i] * gain[i]
        move(moved, n, places, m, queue[WEIGHT + c], start)
    return m
