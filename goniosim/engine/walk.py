"""The random walk, sorted by event instead of by ray.

Every interface has two queues, of rays arriving from above and from below. The fullest queue is
served: a batch of its rays meets the interface in one straight-line loop (`stages.scatter`), then
every ray is routed to a neighbouring queue or out of the stack. All rays of a batch meet the
same kind of interface from the same side, so the loops have no branches, and a scene runs only
the code of the layers it has.
"""

from .._jit import kernel, stage
from ..optics.random import derive_key
from . import tally
from .layout import (
    BOOST,
    DOWN,
    EVENTS,
    GAIN,
    LEFT,
    LOST_CAP,
    REFLECTED_DIRECT,
    REFLECTED_INTERNAL,
    ROUNDS,
    STAGES,
    TRANSMITTED,
    TRANSMITTED_OUT,
    UP,
    WEIGHT,
    X,
    Z,
)
from .sorting import move, sort
from .stages import scatter
from .stages.travel import absorb, drop_dead, roulette

ABOVE, BELOW = 0, 1

# Stages per queue that a part of a work unit may run after its last ray was launched. Rays that are
# still on their way then are booked as lost. No ray is cut before it has met this many interfaces.
MAX_ROUNDS = 10_000


@kernel
def walk(stack, scales, light, part_key, budget, space, ledger, cells):
    """Advance one part of a work unit by about ``budget`` events; returns whether it is finished.

    Parameters
    ----------
    stack : tuple
        Interface and medium tables of `plan.Plan.tables`.
    scales : ndarray, shape (queues, channels)
        Reciprocals of the weights below which a ray is faint, see `faint.faint_weights`.
    light : ndarray, shape (3,)
        Unit vector to the light.
    part_key : uint64
        Key of the part's random numbers.
    budget : int
        Events after which to return to the caller, who looks at signals.
    space : tuple
        The arrays of a `unit.Workspace`: state of the part, number of rays in each queue, queues,
        scratch rows of one batch, one and two rows for sorting it, and the rays that left upwards and
        downwards and await their cell, with their numbers.
    ledger : ndarray, shape (N_LEDGER, channels)
    cells : tuple
        What `tally.flush` needs.
    """
    kinds, alphas, etas, spectral, forgets, taus, absorbs, with_orders = stack
    state, filled, queues, scratch, steps, places, exits, n_exits = space
    n_interfaces = kinds.shape[0]
    batch_size = steps.shape[0]
    channels = ledger.shape[1]
    stop_at = state[EVENTS] + budget
    while state[EVENTS] < stop_at:
        q = fullest(filled)
        key = derive_key(part_key, state[STAGES])
        state[STAGES] += 1
        if filled[q] < batch_size and state[LEFT] > 0:
            n = min(batch_size, state[LEFT])
            state[LEFT] -= n
            # To a queue that holds nothing, since no ray comes back from above.
            q = 0
            filled[q] = n
            _launch(queues[q], n, light, channels)
            gambled = False
        elif filled[q] == 0:
            _leave(exits, n_exits, cells, 1)
            return True
        else:
            if state[LEFT] == 0:
                state[ROUNDS] += 1
                if state[ROUNDS] > MAX_ROUNDS * filled.shape[0]:
                    _cut(queues, filled, ledger)
                    continue
            n = min(batch_size, filled[q])
            medium = q // 2 - 1 if q % 2 == ABOVE else q // 2
            if absorbs[medium]:
                absorb(queues[q], n, taus[medium], scratch[GAIN], scratch[BOOST], ledger)
            gambled = roulette(queues[q], n, scales[q], scratch[BOOST], key, ledger)

        k = q // 2
        side = q % 2
        # The first of the queue, where they lie: what leaves an interface never comes back to the same queue.
        work = queues[q]
        state[EVENTS] += n
        if with_orders and k == 0:
            _count_order(work[WEIGHT + channels], n)
        eta = etas[k] if side == ABOVE else 1.0 / etas[k]
        scatter(kinds[k], work, n, alphas[k], eta, spectral[k], key, scratch, ledger)
        if gambled:
            drop_dead(scratch[GAIN], n, scratch[BOOST])

        n_reflected, n_through = sort(scratch[GAIN], scratch[TRANSMITTED], n, steps, places[0], places[1])
        for through in range(2):
            count = n_through if through else n_reflected
            if count == 0:
                continue
            up = (through == 1) == (side == BELOW)
            if up and k == 0:
                if side == ABOVE:
                    _book_direct(work, n, scratch[GAIN], scratch[TRANSMITTED], ledger)
                else:
                    _gather(work, n, places[through], count, exits[UP], n_exits[UP], X)
                    _book(exits[UP], n_exits[UP], count, ledger, REFLECTED_INTERNAL)
                    n_exits[UP] += count
            elif not up and k == n_interfaces - 1:
                _gather(work, n, places[through], count, exits[DOWN], n_exits[DOWN], X)
                _book(exits[DOWN], n_exits[DOWN], count, ledger, TRANSMITTED_OUT)
                n_exits[DOWN] += count
            else:
                target = 2 * (k - 1) + BELOW if up else 2 * (k + 1) + ABOVE
                first = Z if forgets[target // 2] else X
                _gather(work, n, places[through], count, queues[target], filled[target], first)
                filled[target] += count
        _close_gap(work, n, filled[q], Z if forgets[k] else X)
        filled[q] -= n
        _leave(exits, n_exits, cells, batch_size)
    return False


@stage
def fullest(filled):
    """Number of the queue that holds most."""
    best = 0
    for q in range(1, filled.shape[0]):
        if filled[q] > filled[best]:
            best = q
    return best


@stage
def _launch(work, n, light, channels):
    for field in range(work.shape[0]):
        # What follows the weights is the order, which begins at zero.
        value = 1.0 if field < WEIGHT + channels else 0.0
        if field < WEIGHT:
            value = light[field]
        row = work[field]
        for i in range(n):
            row[i] = value


@stage
def _close_gap(queue, n, filled, first):
    """Move the rays of a queue that were not served to its beginning."""
    for field in range(first, queue.shape[0]):
        row = queue[field]
        rest = row[n:filled]
        for i in range(filled - n):
            row[i] = rest[i]


@stage
def _gather(work, n, places, count, queue, start, first):
    for field in range(first, work.shape[0]):
        move(work[field], n, places, count, queue[field], start)


@stage
def _book(batch, start, count, ledger, entry):
    for c in range(ledger.shape[1]):
        weight = batch[WEIGHT + c][start : start + count]
        total = 0.0
        for i in range(count):
            total += weight[i]
        ledger[entry, c] += total


@stage
def _book_direct(work, n, gain, transmitted, ledger):
    for c in range(ledger.shape[1]):
        weight = work[WEIGHT + c]
        total = 0.0
        for i in range(n):
            total += weight[i] if (gain[i] > 0.0) & (transmitted[i] <= 0.0) else 0.0
        ledger[REFLECTED_DIRECT, c] += total


@stage
def _count_order(order, n):
    for i in range(n):
        order[i] += 1.0


@stage
def _cut(queues, filled, ledger):
    for q in range(filled.shape[0]):
        for c in range(ledger.shape[1]):
            weight = queues[q, WEIGHT + c]
            total = 0.0
            for i in range(filled[q]):
                total += weight[i]
            ledger[LOST_CAP, c] += total
        filled[q] = 0


@stage
def _leave(exits, n_exits, cells, threshold):
    for way in range(2):
        if n_exits[way] >= threshold:
            tally.flush(way, exits[way], n_exits[way], cells)
            n_exits[way] = 0
