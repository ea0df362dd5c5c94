"""How long replicates take, from a trial of two sizes: what each costs in any case, and what a light path adds."""

import math
import threading
import time
from dataclasses import dataclass

import numpy as np

from .blas import one_thread
from .estimate import noise
from .estimators import ESTIMATORS
from .replicates import unfold
from .rounds import REPLICATES, sizes
from .unit import child_key

# Child of the seed 0, for numbers that no replicate uses.
BRANCH = 4
# The largest size that is tried, as doublings of the smallest; seconds that a path takes at the least.
DOUBLINGS = 4
FASTEST = 1e-9
# Replicates of the smallest size whose scatter tells their noise to a sixth.
FEWEST = 16


@dataclass(frozen=True)
class Trial:
    """What a run of replicates costs, and how noisy it is.

    Attributes
    ----------
    smallest : int
        Light paths of the smallest replicate that was made.
    shared : float
        Seconds of what all directions share.
    fixed, slope : float
        Seconds of a call whatever the size of its replicates, and for each unit of that size, in the mean over the
        incident directions.
    calls : int
        In a round, over all directions.
    events_per_path : float
        In the same mean.
    slices : dict of int to ndarray, shape (distinct channels, rows, columns)
        By way out, energies of the middle one of the incident directions.
    spread : dict of int to float
        By way out, noise of those of a single replicate of the smallest size, in sr^-1/2.
    """

    smallest: int
    shared: float
    fixed: float
    slope: float
    calls: int
    events_per_path: float
    slices: dict
    spread: dict

    def seconds(self, rays):
        """Seconds of replicates of so many light paths of each direction, on one thread."""
        return self.calls * sum(self.fixed + self.slope * size for size in sizes(rays, self.smallest))

    def noise(self, side, rays):
        """Noise of a slice after so many light paths, in sr^-1/2; that of a lattice falls faster."""
        return self.spread[side] * math.sqrt(self.smallest / (REPLICATES * sum(sizes(rays, self.smallest))))


def try_replicates(plan, choice):
    """Make some replicates: many of one direction, and one of each other.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    choice : goniosim.engine.estimators.choose.Choice
        Of another estimator than the analog one.

    Returns
    -------
    Trial
    """
    estimator = ESTIMATORS[choice.estimator](plan, choice.sides)
    with one_thread():
        start = time.perf_counter()
        estimator.prepare()
        shared = time.perf_counter() - start
        return _trial(plan, choice, estimator, shared)


def _trial(plan, choice, estimator, shared):
    """Replicates of two sizes."""
    workspace = estimator.workspace()
    slots = sum(int(plan.slots[side, 1]) for side in choice.sides)
    out = np.empty((estimator.chunk, slots, plan.n_distinct, plan.rows, plan.width))
    middle = len(plan.theta_deg) // 2

    def run(size, number=0, count=estimator.chunk, direction=middle):
        keys = [child_key(child_key(0, BRANCH), number + i) for i in range(count)]
        start = time.perf_counter()
        events = workspace.run(direction, size, np.array(keys, np.uint64), out[:count], threading.Event())
        return time.perf_counter() - start, events

    smallest, small, found = estimator.smallest, np.inf, []
    for number in range(0, FEWEST, estimator.chunk):
        small = min(small, run(smallest, number)[0])
        found.append(out.copy())
    for size in (smallest << doublings for doublings in range(1, DOUBLINGS + 1)):
        large, events = run(size)
        # What a path adds must stand out of what a replicate costs in any case.
        if large > 2.0 * small:
            break
    slope = max((large - small) / (size - smallest), FASTEST)
    fixed = max(small - slope * smallest, 0.0)
    of_each = [run(smallest, count=1, direction=direction)[1] for direction in range(len(plan.theta_deg))]
    mean = float(np.mean(of_each)) / max(of_each[middle], 1)
    slices, spread = {}, {}
    for side, energies in _by_way_out(plan, choice.sides, np.concatenate(found)):
        slices[side] = energies.mean(axis=0)
        spread[side] = noise(plan, middle, energies.std(axis=0, ddof=1))
    calls = -(-REPLICATES // estimator.chunk) * len(plan.theta_deg)
    events_per_path = mean * events / (size * estimator.chunk)
    return Trial(smallest, shared, fixed, mean * slope, calls, events_per_path, slices, spread)


def _by_way_out(plan, sides, found):
    """Ways out, each with its slices [replicate, channel, row, column]."""
    first = 0
    for side in sides:
        count = int(plan.slots[side, 1])
        yield side, unfold(found[:, first : first + count].sum(axis=1), plan.columns)
        first += count
