"""Which weights are usual where a ray waits: what is much fainter there is not worth following.

As in `goniosim.engine.faint`, but the weights of this walk differ by what the ways out share: what a clear base
reflects is faint, and all that there is above it. Inner interfaces do not branch in the pilot, or the rays in its
queues, which no roulette ends, would be of ever later generations.
"""

import numpy as np

from ..faint import DIM, after_medium
from ..unit import BATCH, pilot_key
from ..walk import ABOVE, BELOW
from .layout import BASED, FRESH, LATER, LEFT, PHASES

# Paths of the pilot, and stages for each interface after which it ends even if a queue has not been served yet.
PATHS = 1 << 12
STAGES = 64


def usual_weights(plan, workspace):
    """Weights that are usual in every queue, looked up by a pilot that counts nowhere.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    workspace : goniosim.engine.splitting.workspace.Workspace
        Ends only rays without weight.

    Returns
    -------
    ndarray, shape (M, PHASES * 2 K, D)
    """
    return np.stack([_usual(plan, workspace, direction) for direction in range(len(plan.theta_deg))])


def _usual(plan, workspace, direction):
    k = len(plan.kinds)
    usual = np.full((PHASES, k, 2, plan.n_distinct), np.nan)
    for (phase, interface, side), weights in _first_batches(plan, workspace, direction):
        for c, weight in enumerate(weights):
            lit = weight[weight > 0.0]
            usual[phase, interface, side, c] = np.quantile(lit, DIM) if len(lit) else 0.0
    seen = ~np.isnan(usual)
    usual = np.where(seen, usual, np.min(usual, axis=(0, 1, 2), initial=1.0, where=seen))
    # On its way down, and on later rounds, light has to be worth it beside what came the same way before.
    usual[BASED, :, ABOVE] = usual[FRESH, :, ABOVE]
    usual[LATER, :, ABOVE] = usual[FRESH, :, ABOVE]
    usual[LATER, :, BELOW] = usual[BASED, :, BELOW]
    return usual.reshape(PHASES * 2 * k, -1)


def _first_batches(plan, workspace, direction):
    """Yield the queues where light comes first, and the weights (channels, rays) of the first batch there."""
    k = len(plan.kinds)
    waiting = {(FRESH, i, ABOVE) for i in range(1, k)} | {(FRESH, i, BELOW) for i in range(k - 2)}
    waiting |= {(BASED, i, BELOW) for i in range(k - 1)}
    filled = workspace.filled
    workspace.begin(PATHS)
    for _ in range(STAGES * k):
        q = int(np.argmax(filled))
        place = (q // (2 * k), q % (2 * k) // 2, q % 2)
        if place in waiting and (filled[q] >= BATCH or (workspace.state[LEFT] == 0 and filled[q] > 0)):
            waiting.remove(place)
            batch = workspace.queues[q, :, max(0, filled[q] - BATCH) : filled[q]]
            yield place, after_medium(plan, q % (2 * k), batch)
        if not waiting or workspace.advance(direction, pilot_key(direction), 1, crowd=-1):
            return
