"""The driver: work units on threads, their tallies summed in a fixed order, results assembled."""

import threading
import time
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass, field

import numpy as np

from ..cores import granted_threads
from ..errors import ResourceError, StoppedError
from ..integration import Pool
from ..provenance import provenance
from ..result import Cost, Result
from ..scene import CHANNELS, effects, with_arguments
from . import estimate
from .asked import require_known
from .direct import direct_reflection
from .faint import faint_weights
from .layout import DOWN, UP
from .memory import require_memory, threads_of
from .plan import make_plan
from .probe import warm_up
from .schedule import MOST_LEDGERS, Schedule, units_in_flight
from .unit import Tally, Workspace, unit_key

_POLL_SECONDS = 0.1


def simulate(scene, *, progress=None, stop=None, **given):
    """Shoot rays at a scene and return its slices with their error bars.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    progress : callable, optional
        Called as ``progress(done_rays, total_rays)`` a few times a second, from this thread;
        ``total_rays`` is that of the scene, None where a target decides.
    stop : threading.Event, optional
        When set, tracing ends within a second; the result holds the finished work units and
        has the status ``partial``. Ctrl-C itself is left to the caller.
    **given
        In the place of what the scene says: ``rays``, ``seed``, ``threads`` and the others of
        `goniosim.scene.with_arguments`. The result does not depend on ``threads``; the default
        is every core this process may use.

    Returns
    -------
    goniosim.result.Result

    Raises
    ------
    goniosim.errors.ConfigError
        If an argument is out of range, or the engine cannot do what is asked.
    goniosim.errors.ResourceError
        If it does not fit into the memory that is free.
    goniosim.errors.StoppedError
        If it was stopped before any work unit was finished.
    """
    scene = with_arguments(scene, given)
    require_known(scene.simulation)
    require_memory(scene)
    try:
        return _simulate(scene, make_plan(scene), granted_threads(threads_of(scene)), progress, stop)
    except MemoryError as error:
        raise ResourceError(
            "memory ran out: another process took it, or a limit is lower than it looks; "
            "use fewer threads, coarser slices or fewer incident directions per file"
        ) from error


def _simulate(scene, plan, threads, progress, stop):
    run = _Run(plan, scene.simulation.rays, scene.simulation.seed, threads)
    warm_up(plan)
    stop = stop or threading.Event()
    direct = _integrate_direct(plan, threads, stop)
    run.trace(progress or (lambda done, total: None), stop)
    if not any(run.rays):
        raise StoppedError("stopped before the first rays were through: there is nothing to keep")
    found = estimate.components(plan, run.tallies, run.rays, direct)
    return Result(
        config_yaml=scene.to_yaml(),
        config_hash=scene.config_hash(),
        name=scene.material.name,
        status="complete" if run.finished else "partial",
        seed=scene.simulation.seed,
        theta_deg=plan.theta_deg,
        phi_deg=np.zeros_like(plan.theta_deg),
        rays=np.array(run.rays, dtype=np.int64),
        channels=list(CHANNELS),
        cells=estimate.cells(plan),
        components=found,
        audit=estimate.audit(plan, run.ledgers, run.part_rays, found["reflection/direct"]),
        cost=run.cost(),
        effects={effect.name: effect.active for effect in effects(scene)},
        provenance=provenance(threads),
    )


def _integrate_direct(plan, threads, stop):
    """`direct_reflection` of every direction; before tracing, so that a stop need not wait for it."""
    with Pool(threads) as pool:
        return [direct_reflection(plan, direction, pool, stop) for direction in range(len(plan.theta_deg))]


def _added_in_pairs(values):
    return [a + b for a, b in zip(values[::2], values[1::2], strict=True)]


@dataclass
class _Run:
    plan: object
    rays_per_direction: int
    seed: int
    threads: int
    tallies: list = field(init=False)
    checkpoints: list = field(default_factory=list)
    cpu_seconds: float = 0.0
    seconds: float = 0.0
    events: int = 0
    traced: int = 0

    def __post_init__(self):
        directions = len(self.plan.theta_deg)
        self.schedule = Schedule(directions, self.rays_per_direction)
        self.tallies = [Tally(self.plan) for _ in range(directions)]
        self.units = [0] * directions
        self.ledgers = [[] for _ in range(directions)]
        self.part_rays = [[] for _ in range(directions)]

    @property
    def rays(self):
        return [sum(sizes) for sizes in self.part_rays]

    @property
    def finished(self):
        return all(units == self.schedule.rounds for units in self.units)

    def trace(self, progress, stop):
        """Run all work units, summing their tallies in the order of the schedule."""
        start, cpu_start = time.perf_counter(), time.thread_time()
        faint = faint_weights(self.plan)
        self.cpu_seconds += time.thread_time() - cpu_start
        in_flight = units_in_flight(self.schedule, self.threads)
        spare = [Tally(self.plan) for _ in range(in_flight)]
        local = threading.local()
        pending = {}
        done = {}
        submitted = reduced = 0
        total_rays = len(self.plan.theta_deg) * self.rays_per_direction
        checkpoints = set(self.schedule.checkpoints)

        def work(number, tally):
            direction, unit, rays = self.schedule[number]
            if stop.is_set():
                return None
            if not hasattr(local, "workspace"):
                local.workspace = Workspace(self.plan, faint)
            key = unit_key(self.seed, direction, unit)
            return local.workspace.run(direction, rays, key, tally, stop)

        with ThreadPoolExecutor(self.threads) as pool:
            try:
                while reduced < len(self.schedule):
                    while spare and submitted < len(self.schedule) and not stop.is_set():
                        tally = spare.pop()
                        pending[pool.submit(work, submitted, tally)] = (submitted, tally)
                        submitted += 1
                    if not pending:
                        break
                    finished, _ = wait(pending, timeout=_POLL_SECONDS, return_when=FIRST_COMPLETED)
                    for future in finished:
                        number, tally = pending.pop(future)
                        done[number] = (future.result(), tally)
                    while reduced in done:
                        report, tally = done.pop(reduced)
                        self._reduce(reduced, report, tally)
                        tally.clear()
                        spare.append(tally)
                        reduced += 1
                        self.seconds = time.perf_counter() - start
                        round_, rest = divmod(reduced, len(self.plan.theta_deg))
                        if rest == 0 and round_ in checkpoints and not stop.is_set():
                            self._checkpoint()
                    progress(self.traced, total_rays)
            except BaseException:
                stop.set()
                raise
        if not self.finished:
            self._checkpoint()

    def _reduce(self, number, report, tally):
        direction, unit, _ = self.schedule[number]
        # After a stop, units of a direction count only as far as none is missing before them.
        if report is None or unit != self.units[direction]:
            return
        self.units[direction] += 1
        self.tallies[direction].histogram += tally.histogram
        self.ledgers[direction].extend(tally.ledgers.copy())
        self.part_rays[direction].extend(report.part_rays)
        if len(self.ledgers[direction]) >= 2 * MOST_LEDGERS:
            self.ledgers[direction] = _added_in_pairs(self.ledgers[direction])
            self.part_rays[direction] = _added_in_pairs(self.part_rays[direction])
        self.traced += report.rays
        self.cpu_seconds += report.cpu_seconds
        self.events += report.events

    def _checkpoint(self):
        rays = self.rays
        error = {
            name: estimate.noise(self.plan, self.tallies, rays, side)
            for side, name in estimate.COMPONENT_OF.items()
            if self.plan.slots[side, 1] > 0
        }
        self.checkpoints.append((float(np.mean(rays)), self.seconds, self.cpu_seconds, error))

    def cost(self):
        names = [estimate.COMPONENT_OF[side] for side in (UP, DOWN) if self.plan.slots[side, 1] > 0]
        rays, seconds, cpu_seconds, errors = zip(*self.checkpoints, strict=True)
        return Cost(
            rays=np.array(rays),
            seconds=np.array(seconds),
            cpu_seconds=np.array(cpu_seconds),
            error={name: np.array([error[name] for error in errors]) for name in names},
        )
