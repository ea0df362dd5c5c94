"""What this machine can do with a scene: compile its kernels, and trace it for a moment."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from ..cores import available_cores
from .plan import Plan, make_plan
from .unit import Tally, Workspace, unit_key

_RAYS_PER_UNIT = 1 << 13


def warm_up(scene):
    """Compile the kernels, or load them from the cache; returns the seconds it took.

    Parameters
    ----------
    scene : goniosim.scene.Scene or Plan
    """
    plan = scene if isinstance(scene, Plan) else make_plan(scene)
    start = time.perf_counter()
    Workspace(plan).run(0, 1, unit_key(0, 0, 0), Tally(plan), threading.Event())
    return time.perf_counter() - start


@dataclass(frozen=True)
class Probe:
    """What a short trial run says about a scene.

    Attributes
    ----------
    rays_per_second : float
        Over all threads.
    events_per_ray : float
        Mean number of interfaces a ray meets.
    compile_seconds : float
        Time to compile the kernels or to load them from the cache.
    """

    rays_per_second: float
    events_per_ray: float
    compile_seconds: float


def probe(scene, seconds=1.0, threads=None):
    """Trace the scene for about ``seconds``, all directions in turn, and measure; see `Probe`."""
    plan = make_plan(scene)
    threads = threads or scene.simulation.threads or available_cores()
    compile_seconds = warm_up(plan)
    directions = len(plan.theta_deg)
    spaces = [(Workspace(plan), Tally(plan)) for _ in range(threads)]
    start = time.perf_counter()

    def work(number):
        workspace, tally = spaces[number]
        rays = events = 0
        unit = number
        while rays == 0 or time.perf_counter() - start < seconds:
            key = unit_key(scene.simulation.seed, unit % directions, unit)
            report = workspace.run(unit % directions, _RAYS_PER_UNIT, key, tally, threading.Event())
            rays += report.rays
            events += report.events
            unit += threads
        return rays, events

    with ThreadPoolExecutor(threads) as pool:
        totals = list(pool.map(work, range(threads)))
    elapsed = time.perf_counter() - start
    rays = sum(total[0] for total in totals)
    return Probe(rays / elapsed, sum(total[1] for total in totals) / rays, compile_seconds)
