"""How long replicates take, from a trial of two sizes: what each costs in any case, and what a light path adds."""

import threading
import time

import numpy as np

from .blas import one_thread
from .estimators import ESTIMATORS
from .rounds import REPLICATES, SMALLEST, sizes
from .unit import child_key

# Child of the seed 0, for numbers that no replicate uses.
BRANCH = 4
# The largest size that is tried, as doublings of the smallest; seconds that a path takes at the least.
DOUBLINGS = 4
FASTEST = 1e-9


def replicated_seconds(plan, choice, rays, threads):
    """Predict the time of a run of replicates.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    choice : goniosim.engine.estimators.choose.Choice
        Of another estimator than the analog one.
    rays : int
        Light paths of each direction.
    threads : int

    Returns
    -------
    seconds : float
        Of wall-clock time.
    events_per_path : float
    """
    estimator = ESTIMATORS[choice.estimator](plan, choice.sides)
    with one_thread():
        start = time.perf_counter()
        estimator.prepare()
        shared = time.perf_counter() - start
        small, size, large, events = _two_sizes(plan, choice, estimator)
    slope = max((large - small) / (size - SMALLEST), FASTEST)
    fixed = max(small - slope * SMALLEST, 0.0)
    chunks = -(-REPLICATES // estimator.chunk)
    found = sizes(rays)
    seconds = chunks * sum(fixed + slope * size for size in found) * len(plan.theta_deg)
    return shared + seconds / threads, events / float(size * estimator.chunk)


def _two_sizes(plan, choice, estimator):
    """Seconds of a chunk of the smallest replicates; size, seconds and events of one of larger ones."""
    workspace = estimator.workspace()
    slots = sum(int(plan.slots[side, 1]) for side in choice.sides)
    out = np.empty((estimator.chunk, slots, plan.n_distinct, plan.rows, plan.width))
    keys = np.array([child_key(child_key(0, BRANCH), i) for i in range(estimator.chunk)], np.uint64)
    middle = len(plan.theta_deg) // 2

    def run(size):
        start = time.perf_counter()
        events = workspace.run(middle, size, keys, out, threading.Event())
        return time.perf_counter() - start, events

    small = min(run(SMALLEST)[0] for _ in range(2))
    for size in (SMALLEST << doublings for doublings in range(1, DOUBLINGS + 1)):
        large, events = run(size)
        # What a path adds must stand out of what a replicate costs in any case.
        if large > 2.0 * small:
            break
    return small, size, large, events
