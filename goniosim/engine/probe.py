"""What this machine can do with a scene: compile its kernels, and trace it for a moment."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from ..cores import granted_threads
from .blas import one_thread
from .estimators import ESTIMATORS
from .estimators.choose import ANALOG, choose
from .faint import faint_weights
from .gain import expected
from .layout import LOST_CAP
from .memory import threads_of
from .plan import make_plan
from .rounds import FEWEST_PATHS
from .trial import try_replicates
from .unit import Tally, Workspace, unit_key

# Rays between two looks at the clock: fewer where each of them meets many interfaces.
_RAYS_PER_UNIT = 1 << 13
_MOST_EVENTS = 1 << 18


# Interfaces that catch light between them, so that the limit on the number of events may cut some of it off. Light
# that has entered through the first of two finds its way out again.
_FEWEST_TO_TRAP = 3


def warm_up(scene):
    """Compile the kernels of a simulation, or load them from the cache; returns the seconds it took.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    """
    plan = make_plan(scene)
    choices = choose(plan, scene.simulation.estimator, scene.simulation.rays)
    # Where no slices are by independent paths, the energy balance is.
    return _warm_up(plan, choices, walks=True)


def _warm_up(plan, choices, walks):
    start = time.perf_counter()
    if walks:
        Workspace(plan).run(0, 1, unit_key(0, 0, 0), Tally(plan), threading.Event())
    with one_thread():
        for choice in choices:
            _warm_up_replicates(plan, choice)
    return time.perf_counter() - start


_warm = set()


def _warm_up_replicates(plan, choice):
    """Make a replicate of two paths, once for what kernels differ in."""
    kind = (
        choice.estimator,
        choice.sides,
        plan.n_distinct,
        plan.kinds.tobytes(),
        plan.parametrization,
        plan.orders > 0,
    )
    if choice.estimator not in ESTIMATORS or kind in _warm:
        return
    _warm.add(kind)
    estimator = ESTIMATORS[choice.estimator].tiny(plan, choice.sides)
    estimator.prepare()
    few = estimator.plan
    slots = sum(int(few.slots[side, 1]) for side in choice.sides)
    out = np.empty((1, slots, few.n_distinct, few.rows, few.width))
    estimator.workspace().run(0, 2, np.zeros(1, np.uint64), out, threading.Event())


@dataclass(frozen=True)
class Probe:
    """What a short trial run says about a scene.

    Attributes
    ----------
    rays_per_second : float
        Over all threads.
    events_per_ray : float
        Mean number of interfaces a ray meets, or what costs as much.
    compile_seconds : float
        Time to compile the kernels of the trial, or to load them from the cache.
    rays : int
        Independent rays traced, all directions together; 0 where nothing depends on them.
    lost_event_cap : float
        Share of the flux that was lost at the event cap, the largest of all directions and channels.
    gains : dict of str to float
        By component, how many times the processor time independent paths would take for the same noise; without
        those of independent paths, and where the probe saw nothing. Empty if they were not asked for.
    """

    rays_per_second: float
    events_per_ray: float
    compile_seconds: float
    rays: int
    lost_event_cap: float
    gains: dict


def probe(scene, seconds=1.0, gains=False):
    """Trace the scene for about ``seconds``, all directions in turn, and measure; see `Probe`.

    The independent paths of the energy balance are few: nothing is tried of them but whether they are caught, unless
    the ``gains`` over them are asked for.
    """
    plan = make_plan(scene)
    threads = granted_threads(threads_of(scene))
    choices = choose(plan, scene.simulation.estimator, scene.simulation.rays)
    replicated = [choice for choice in choices if choice.estimator != ANALOG]
    walks = gains or len(replicated) < len(choices) or len(plan.kinds) >= _FEWEST_TO_TRAP
    compile_seconds = _warm_up(plan, choices, walks)
    rays, events, lost, elapsed, histogram = (0, 0, 0.0, 0.0, None)
    if walks:
        rays, events, lost, elapsed, histogram = _walk(scene, plan, threads, seconds)
    found = {}
    if replicated:
        directions, asked = len(plan.theta_deg), scene.simulation.most_rays
        tried = [try_replicates(plan, choice) for choice in replicated]
        whole = sum(each.shared + each.seconds(asked) / threads for each in tried)
        if len(replicated) < len(choices):
            whole += directions * asked * elapsed / rays
        rate, events_per_ray = directions * asked / whole, sum(each.events_per_path for each in tried)
        if gains:
            few = scene.simulation.rays or FEWEST_PATHS
            found = expected(plan, tried, histogram, rays, threads * elapsed / rays, few)
    else:
        rate, events_per_ray = rays / elapsed, events / rays
    return Probe(rate, events_per_ray, compile_seconds, rays, lost, found)


def _walk(scene, plan, threads, seconds):
    """Independent paths: rays, events, largest share lost at the event cap, seconds, and the histogram."""
    directions = len(plan.theta_deg)
    faint = faint_weights(plan)
    unit_rays = max(1, min(_RAYS_PER_UNIT, _MOST_EVENTS // len(plan.kinds)))
    spaces = [(Workspace(plan, faint), Tally(plan)) for _ in range(threads)]
    start = time.perf_counter()

    def work(number):
        workspace, tally = spaces[number]
        rays = np.zeros(directions, np.int64)
        lost = np.zeros((directions, plan.n_distinct))
        events = 0
        unit = number
        while events == 0 or time.perf_counter() - start < seconds:
            direction = unit % directions
            key = unit_key(scene.simulation.seed, direction, unit)
            report = workspace.run(direction, unit_rays, key, tally, threading.Event())
            rays[direction] += report.rays
            lost[direction] += tally.ledgers[:, LOST_CAP].sum(axis=0)
            tally.ledgers.fill(0.0)
            events += report.events
            unit += threads
        return rays, events, lost

    with ThreadPoolExecutor(threads) as pool:
        totals = list(pool.map(work, range(threads)))
    elapsed = time.perf_counter() - start
    rays, events, lost = (sum(total[i] for total in totals) for i in range(3))
    histogram = sum(tally.histogram for _, tally in spaces)
    return int(rays.sum()), events, float((lost / np.maximum(rays, 1)[:, None]).max()), elapsed, histogram
