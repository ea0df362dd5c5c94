"""The kernel of the split walk."""

from ..._jit import kernel, stage
from ...optics.random import derive_key, uniform
from ..layout import DOWN, UP, WEIGHT, X, Z
from ..loops import multiply
from ..stages import LAMBERT, ROUGH_DIELECTRIC, SMOOTH_DIELECTRIC
from ..stages.travel import absorb, roulette
from ..walk import ABOVE, BELOW, fullest
from .base import meet_base
from .deposit import leave, share_out
from .dielectric import go_through, meet_dielectric, turn_back
from .exits import let_through
from .layout import (
    BACK_GAIN,
    BACK_X,
    BACK_Y,
    BACK_Z,
    BASE,
    BASED,
    ENTRY,
    EVENTS,
    EXIT,
    FACET_RATIO,
    FACET_X,
    FACET_Y,
    FACET_Z,
    FRESH,
    HASHED,
    LATER,
    LAUNCHED,
    LEFT,
    PATH,
    POINT_U,
    POINT_V,
    RADIUS,
    RATIO,
    ROUNDS,
    STAGES,
    THROUGH_GAIN,
    THROUGH_X,
    THROUGH_Y,
    THROUGH_Z,
    TURN,
)
from .lobes import FEWER_LATER
from .numbers import facet_numbers, hashed_points, lattice_points
from .queues import close_up, launch, pop, push

# A stage takes at least as long as so many events in the midst of many.
EVENTS_PER_STAGE = 16

# Children of the stage's key: 0 and 1 are the points, 2 azimuths, 3 the roulette.
_COIN_KEY = 4


@kernel
def split_walk(stack, scales, facets, crowd, light, paths_key, shifts, budget, rounds, space, ledger, cells):
    """Advance one replicate by about ``budget`` events, or by as many stages as take as long.

    Returns whether it is finished.

    Parameters
    ----------
    stack : tuple
        Interface and medium tables of `plan.Plan.tables`.
    scales : ndarray, shape (queues, channels)
        Reciprocals of the weights below which a ray is faint.
    facets : ndarray of int64, shape (2,)
        For exits upwards and downwards, the facets of an arrival; 0 where nobody looks.
    crowd : int
        Rays in the fullest queue, above which an inner interface does not branch.
    light : ndarray, shape (3,)
    paths_key : uint64
    shifts : ndarray, shape (lattice.DIMENSIONS,)
        Of the lattice of all paths.
    budget : int
    rounds : int
        Stages after the start of the last path, at which what is still inside is lost.
    space : tuple
        Arrays of the workspace: state, rays in each queue, queues, one batch, its scratch, and one row of
        places.
    ledger : ndarray, shape (N_LEDGER, channels)
        Overwritten, and without meaning: losses are not this walk's business.
    cells : tuple
        See `deposit.leave`.
    """
    kinds, alphas, etas, spectral, forgets, taus, absorbs, with_orders = stack
    state, filled, queues, batch, scratch, places = space
    interfaces = kinds.shape[0]
    last = interfaces - 1
    channels = scales.shape[1]
    most = batch.shape[1]
    path = batch[PATH]
    stop_at = state[EVENTS] + budget
    last_stage = state[STAGES] + max(1, budget // EVENTS_PER_STAGE)
    while state[EVENTS] < stop_at and state[STAGES] < last_stage:
        q = fullest(filled)
        key = derive_key(paths_key, state[STAGES])
        state[STAGES] += 1
        crowded = filled[q] > crowd
        if filled[q] < most and state[LEFT] > 0:
            n = min(most, state[LEFT])
            launch(batch, n, light, channels, state[LAUNCHED])
            state[LEFT] -= n
            state[LAUNCHED] += n
            state[EVENTS] += n
            k, side, phase, dimension = 0, ABOVE, FRESH, ENTRY
        elif filled[q] == 0:
            return True
        else:
            if state[LEFT] == 0:
                state[ROUNDS] += 1
                if state[ROUNDS] > rounds:
                    return True
            phase, arrival = q // (2 * interfaces), q % (2 * interfaces)
            k, side = arrival // 2, arrival % 2
            n = min(most, filled[q])
            filled[q] -= n
            pop(queues[q], filled[q], batch, n, Z if forgets[k] else X)
            medium = k - 1 if side == ABOVE else k
            if absorbs[medium]:
                absorb(batch, n, taus[medium], scratch[RADIUS], scratch[TURN], ledger)
            state[EVENTS] += n
            if roulette(batch, n, scales[q], scratch[RADIUS], key, ledger):
                n = close_up(batch, n, scratch[RADIUS], places)
            dimension = BASE if k == last and phase == FRESH else EXIT if k == 0 and phase == BASED else HASHED

        if with_orders and k == 0:
            _count_order(batch[WEIGHT + channels], n)
        opaque = kinds[k] != ROUGH_DIELECTRIC and kinds[k] != SMOOTH_DIELECTRIC
        way = UP if k == 0 and side == BELOW else DOWN if k == last and side == ABOVE else -1
        free = kinds[last] == LAMBERT and phase != FRESH
        seen = way >= 0 and not opaque and facets[way] > 0
        rough = kinds[k] == ROUGH_DIELECTRIC
        m = 1 if free or not seen or not rough else max(1, facets[way] // (FEWER_LATER if phase == LATER else 1))
        if dimension == HASHED:
            hashed_points(n, key, scratch[POINT_U], scratch[POINT_V])
        else:
            lattice_points(path, n, m, dimension, shifts, scratch[POINT_U], scratch[POINT_V])

        if opaque:
            meet_base(kinds[k], batch, n, alphas[k], spectral[k], scratch)
        else:
            eta = etas[k] if side == ABOVE else 1.0 / etas[k]
            for number in range(m - 1):
                let_through(batch, n, number, dimension, alphas[k], eta, 1.0 / m, scratch)
                leave(way, batch, n, False, key, channels, scratch, places, cells)
            state[EVENTS] += (m - 1) * n
            # The last facet also reflects what goes on inside.
            if rough:
                u, v = scratch[POINT_U], scratch[POINT_V]
                fx, fy, fz = scratch[FACET_X], scratch[FACET_Y], scratch[FACET_Z]
                facet_numbers(u, v, n, m - 1, dimension, batch[RATIO], fx, fy, fz, scratch[FACET_RATIO])
            meet_dielectric(kinds[k], batch, n, alphas[k], eta, scratch)
            turn_back(kinds[k], batch, n, alphas[k], scratch)
            if seen or way < 0:
                go_through(kinds[k], batch, n, alphas[k], eta, scratch)
            if seen:
                share_out(batch, n, 1.0 / m, rough, scratch)
                state[EVENTS] += leave(way, batch, n, free, key, channels, scratch, places, cells)
            if rough:
                multiply(batch[RATIO], n, scratch[FACET_RATIO])
            if way < 0 and crowded and not (k == 0 and side == ABOVE):
                _toss(scratch[THROUGH_GAIN], scratch[BACK_GAIN], n, derive_key(key, _COIN_KEY))

        if k == last:
            phase = max(phase, BASED)
        elif k == 0 and phase == BASED:
            phase = LATER
        for through in range(2):
            up = (through == 1) == (side == BELOW)
            beyond = k - 1 if up else k + 1
            # Light that the top reflects at once is integrated elsewhere.
            if beyond < 0 or beyond > last or (through == 1 and opaque):
                continue
            arrival = 2 * beyond + (BELOW if up else ABOVE)
            target = 2 * interfaces * phase + arrival
            x = scratch[THROUGH_X] if through == 1 else scratch[BACK_X]
            y = scratch[THROUGH_Y] if through == 1 else scratch[BACK_Y]
            z = scratch[THROUGH_Z] if through == 1 else scratch[BACK_Z]
            gain = scratch[THROUGH_GAIN] if through == 1 else scratch[BACK_GAIN]
            first = Z if forgets[beyond] else X
            queue = queues[target]
            filled[target] += push(batch, n, x, y, z, gain, channels, places, queue, filled[target], first)
    return False


@stage
def _count_order(order, n):
    for i in range(n):
        order[i] += 1.0


@stage
def _toss(through, back, n, key):
    """Follow one branch, chosen by the weights of both."""
    for i in range(n):
        total = through[i] + back[i]
        passes = uniform(key, i) * total < through[i]
        through[i] = total if passes else 0.0
        back[i] = 0.0 if passes else total
