"""The forward walk that only bins what arrives at one interface.

Light enters for certain. At inner interfaces both branches are followed: a coin would make the dim ones too rare. What
an outermost interface lets through is not followed. As in `goniosim.engine.walk`, every interface has two queues, and
batches of the fullest one meet it in loops without branches. Every ray carries the key of its random numbers, so that
paths do not depend on what waits beside them, but for the coin that takes the place of both branches in a crowd.
"""

from ..._jit import kernel, stage
from ...optics.fresnel import fresnel_dielectric
from ...optics.random import derive_key
from ..lattice import DIMENSIONS
from ..loops import colour, scale, share_out
from ..stages import LAMBERT, ROUGH_CONDUCTOR, SMOOTH_CONDUCTOR, SMOOTH_DIELECTRIC
from ..stages.lambert import RHO
from ..stages.smooth_conductor import ETA, KAPPA
from ..walk import ABOVE, BELOW, MAX_ROUNDS, fullest
from .bins import clear, deposit
from .branches import absorb, enter, find_brightest, forget, go_through, turn_back
from .facets import draw, draw_lattice, meet_facets
from .nodes import stencils
from .queues import FAINT, NEVER, close_up, derive_keys, launch, play, pop, push, toss
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
    LEAST_COSINE,
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
# Dimensions of the lattice that entry takes; the first event inside takes the rest.
_ENTRY = DIMENSIONS // 2
# Where less than the reciprocal enters, that matters.
_LITTLE = 10.0


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
    to_horizon, half_turn = bins.shape[2] // channels - 1, bins.shape[1] - 1
    slots = bins.shape[0] // keys.shape[0]
    most = steps.shape[0]
    usual = FAINT * _entering(kinds[0], light, etas[0])
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
            launch(batch, n, light, number, replicate * slots + min(1 + target[2], slots - 1), scratch[NEXT_KEY])
            draw_lattice(scratch[NEXT_KEY], n, alphas[0], derive_key(key, SHIFTS), 0, scratch)
            meet_facets(batch, n, alphas[0], scratch)
            enter(light, n, alphas[0], etas[0], scratch)
            n = close_up(batch, n, channels, scratch, steps, lists)
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
            pop(queues[q], filled[q], batch, n)

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
            stencils(batch[X], batch[Y], batch[Z], batch[RATIO], n, to_horizon, half_turn, polar, around, nodes)
            deposit(batch[WEIGHT:], batch[SLOT], n, polar, around, nodes, bins)
        if slots > 1 and k == 0:
            _count_order(batch[SLOT], n, slots)

        if starts:
            draw_lattice(batch[KEY], n, alphas[k], derive_key(key, SHIFTS), _ENTRY, scratch)
            derive_keys(batch[KEY], n, derive_key(key, PATHS))
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
                    toss(batch[KEY], n, scratch[REFLECTANCE])
            turn_back(batch, n, alphas[k], scratch)
        find_brightest(batch, n, channels, scratch[BRIGHTEST])
        for through in range(2 if inner else 1):
            if through == 1:
                go_through(batch, n, alphas[k], eta, scratch)
            up = (through == 1) == (side == BELOW)
            q = 2 * (k - 1) + BELOW if up else 2 * (k + 1) + ABOVE
            # What arrives next at the interface is binned first: it may be all that a dim base sends back.
            faint = NEVER if q == 2 * target[0] + target[1] else usual
            play(batch[KEY], n, through, faint, scratch[BRIGHTEST], scratch[GAIN], scratch[NEXT_KEY])
            first = Z if kinds[q // 2] == LAMBERT else X
            filled[q] += push(batch, n, channels, scratch, steps, lists, queues[q], filled[q], first)
    return False


@stage
def _entering(kind, light, eta):
    """Some times the share of the light that enters, and 1 at the most.

    Beside that a ray is faint: next to the horizon all would be, and the light of the few that live on missed.
    """
    if kind != SMOOTH_DIELECTRIC:
        return 1.0
    reflectance, _ = fresnel_dielectric(max(light[2], LEAST_COSINE), eta)
    return min(1.0, _LITTLE * (1.0 - reflectance))


@stage
def _lift(z, n):
    for i in range(n):
        z[i] = max(z[i], LEAST_COSINE)


@stage
def _fill(row, n, value):
    for i in range(n):
        row[i] = value


@stage
def _count_order(slot, n, slots):
    for i in range(n):
        number = int(slot[i]) + 1
        slot[i] = number if number % slots > 0 else number - 1
