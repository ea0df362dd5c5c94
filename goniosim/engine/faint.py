"""How faint a ray must be before Russian roulette may end it: relative to what is usual at its place.

A threshold for all places alike would take every ray below a dark layer for a faint one, and the
few survivors would carry all that the cells see. So each queue has a threshold of its own for
each channel and incident direction: a hundredth of the weight that is usual there. A ray is faint
only if it is so in every channel.

What is usual is looked up once, by a pilot of a few thousand rays that no roulette ends and that
are counted nowhere. A queue holds several populations, such as light from the interface below and
from the base. Taken is the lower quartile of the first batch that the queue serves: a dim
population counts if it makes up a quarter of the rays, and long chains of reflections, which come
later, do not drag the threshold down with them. The pilot has a key of its own: the thresholds
depend on the scene alone, and the roulette is fair whatever they are.
"""

import numpy as np

from .layout import LEFT, N_LEDGER, WEIGHT, Z
from .tally import record_length
from .unit import BATCH, DARKEST, Workspace, pilot_key

# A ray fainter than this, relative to what is usual at its queue, plays.
FAINT = 1e-2
# Share of the rays at a queue that are dimmer than what counts as usual there.
DIM = 0.25
# Rays of the pilot, and stages after which it ends even if a queue has not been served yet.
RAYS = 1 << 12
STAGES = 1000


def faint_weights(plan):
    """Weights below which a ray plays Russian roulette.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan

    Returns
    -------
    ndarray, shape (M, 2 K, distinct channels)
        For every incident direction and queue: that of the rays that arrive at interface k from above
        has the number 2 k, from below 2 k + 1.
    """
    workspace = Workspace(plan)
    usual = np.stack([_usual(plan, workspace, direction) for direction in range(len(plan.theta_deg))])
    return np.maximum(FAINT * usual, DARKEST)


def _usual(plan, workspace, direction):
    usual = np.full((2 * len(plan.kinds), plan.n_distinct), np.nan)
    for q, weights in _first_batches(plan, workspace, direction):
        for c, weight in enumerate(weights):
            lit = weight[weight > 0.0]
            usual[q, c] = np.quantile(lit, DIM) if len(lit) else 0.0
    # Where hardly a ray comes, what is usual at the dimmest place is dim enough.
    seen = ~np.isnan(usual)
    return np.where(seen, usual, np.min(usual, axis=0, initial=1.0, where=seen))


def _first_batches(plan, workspace, direction):
    """Yield every queue that the pilot serves, and the weights (channels, rays) of its first batch there."""
    # One cell holds all that leaves.
    cells = workspace.cells(direction, 1, 1, np.zeros((plan.n_slots, record_length(plan.n_distinct))))
    ledger = np.zeros((N_LEDGER, plan.n_distinct))
    key = pilot_key(direction)
    filled, queues = workspace.filled, workspace.queues
    waiting = set(range(len(filled)))
    workspace.begin(RAYS)
    for _ in range(STAGES):
        q = int(np.argmax(filled))
        if q in waiting and (filled[q] >= BATCH or (workspace.state[LEFT] == 0 and filled[q] > 0)):
            waiting.remove(q)
            batch = queues[q, :, : min(BATCH, filled[q])]
            yield q, after_medium(plan, q, batch)
        if workspace.advance(direction, key, 1, ledger, cells):
            return


def after_medium(plan, q, batch):
    """Weights of the rays of a queue, less what the medium absorbs that they have just crossed."""
    tau = plan.taus[q // 2 - 1 if q % 2 == 0 else q // 2]
    path = 1.0 / np.maximum(batch[Z], DARKEST)
    with np.errstate(under="ignore"):
        return batch[WEIGHT : WEIGHT + len(tau)] * np.exp(-tau[:, None] * path)
