"""How much memory a simulation takes, told from the shapes of its arrays before any is made.

The peak comes in one of three phases: while rays are traced, when the tallies become a result, or
when the result becomes a file.
"""

from dataclasses import dataclass, replace

from ..cores import available_cores
from ..errors import ResourceError
from ..free_memory import free_memory, resident_memory
from ..sums import BATCHES, BLOCKS
from .analog import AnalogRun
from .estimators import ESTIMATORS
from .estimators.choose import ANALOG, choose
from .layout import DOWN, N_LEDGER, N_SCRATCH, UP, WEIGHT
from .plan import make_plan
from .replicated import ReplicatedRun
from .rounds import chunks
from .runs import in_flight
from .schedule import AUDIT_RAYS, MOST_LEDGERS, MOST_SECTIONS, Schedule
from .sorting import LANES
from .tally import record_length
from .unit import BATCH, PARTS, queue_capacity

# Bytes of a number.
_NUMBER = 8
# Measured: the interpreter, the libraries and the kernels, with the compiler of a first run; and the parts of
# cells in work while the direct reflection is integrated.
_PROGRAM = 300_000_000
# Of a thread, besides its arrays.
_THREAD = 1_000_000
# Python's objects around a ledger.
_LEDGER = 200
# Size of a file, relative to the arrays in it; while it is made, it exists twice.
_WRITTEN = 2 * 0.9


@dataclass(frozen=True)
class Memory:
    """Bytes of memory by what holds them.

    Attributes
    ----------
    program : int
        The interpreter, the libraries, the compiled code.
    cells : int
        Geometry of the cells.
    direct : int
        Direct reflection on all cells.
    tallies : int
        Sums over the work units of all directions.
    threads : int
        Tallies of the work units in flight.
    queues : int
        Rays in the queues of the interfaces, of all threads.
    audit : int
        Energy balances of the parts of the work units.
    result : int
        The finished result.
    file : int
        The file while it is written.
    scratch : int
        What passes by while tallies become slices.
    estimators : int
        What all directions share of estimators other than analog, such as the kernels of operators.
    state : int
        What an interrupted run goes on from, alone and in its file; left out where there is no room for it, so that
        it belongs to no phase.
    """

    program: int
    cells: int
    direct: int
    tallies: int
    threads: int
    queues: int
    audit: int
    result: int
    file: int
    scratch: int
    estimators: int
    state: int

    @property
    def phases(self):
        """Names of what is held at the same time, for every phase."""
        held = ("program", "cells", "direct", "tallies", "audit", "scratch")
        return (*held, "threads", "queues", "estimators"), (*held, "result"), ("program", "result", "file")

    @property
    def checkpoint(self):
        """Bytes that it takes to keep a run while it goes on: its sums once more, their result and their file."""
        return self.tallies + self.scratch + self.result + self.file + self.state

    @property
    def peak(self):
        """Bytes when most is held."""
        return max(sum(getattr(self, name) for name in phase) for phase in self.phases)

    @property
    def largest(self):
        """Name of what takes most of the peak, besides the program."""
        phase = max(self.phases, key=lambda names: sum(getattr(self, name) for name in names))
        return max(phase[1:], key=lambda name: getattr(self, name))


def memory_needed(scene):
    """Predict what the simulation of a scene will hold.

    Parameters
    ----------
    scene : goniosim.scene.Scene

    Returns
    -------
    Memory
        An upper estimate: all cells are taken to be hit.
    """
    return _needed(make_plan(scene), scene.simulation, threads_of(scene))


def threads_of(scene):
    """Threads that a scene is simulated on."""
    return scene.simulation.threads or available_cores()


def _needed(plan, simulation, threads):
    choices = choose(plan, simulation.estimator, simulation.rays)
    rays = simulation.most_rays
    analog = any(choice.estimator == ANALOG for choice in choices)
    walked, walked_rays = (plan, rays) if analog else (plan.in_one_cell(), min(rays, AUDIT_RAYS))
    parts = _of_result(plan) | _of_walk(walked, walked_rays, threads) | {"estimators": 0}
    for choice in choices:
        if choice.estimator != ANALOG:
            for name, n_bytes in _of_replicates(plan, choice, threads).items():
                parts[name] += n_bytes
    return Memory(**parts, state=2 * parts["tallies"])


def _of_result(plan):
    directions, distinct, channels = len(plan.theta_deg), plan.n_distinct, len(plan.position)
    cells = plan.rows * plan.columns
    # A slice for each way out, and one for each order.
    counts = [int(plan.slots[side, 1]) for side in (UP, DOWN)]
    sampled = sum((1 + count if plan.orders else 1) for count in counts if count)
    # Four numbers for each channel, hits, and in an eighth of a number whether the cell is uncertain.
    slices = (1 + sampled) * 4 * channels + sampled + sampled * channels / 8
    # Two numbers and a flag.
    geometry = 2 * _NUMBER + 1
    return {
        "program": _PROGRAM,
        "cells": directions * cells * geometry,
        "direct": directions * 2 * distinct * cells * _NUMBER,
        "result": int(directions * cells * (slices * _NUMBER + geometry)),
        "file": int(_WRITTEN * directions * cells * (slices * _NUMBER + geometry)),
    }


def _of_walk(plan, rays, threads):
    directions, distinct = len(plan.theta_deg), plan.n_distinct
    cells = plan.rows * plan.columns
    record = record_length(distinct)
    tally = plan.n_slots * cells * record * _NUMBER
    schedule = Schedule(directions, rays)
    threads = min(threads, len(schedule))
    ledgers = min(PARTS * schedule.rounds, 2 * MOST_LEDGERS)
    # Sections of several work units have tallies of their own.
    tallies = 2 if schedule.rounds > MOST_SECTIONS else 1
    return {
        "tallies": tallies * directions * tally,
        "threads": in_flight(AnalogRun.waiting, threads, len(schedule)) * tally + threads * _THREAD,
        "queues": threads * _queues(plan) + 2 * directions * _thresholds(plan),
        # The balance of one direction needs three copies of its ledgers.
        "audit": (directions + 3) * ledgers * (N_LEDGER * distinct * _NUMBER + _LEDGER),
        "scratch": cells * (record + 8 * distinct) * _NUMBER,
    }


def _of_replicates(plan, choice, threads):
    """Sums of all directions, buffers of the replicates in flight, and what the estimator itself holds."""
    estimator = ESTIMATORS[choice.estimator](plan, choice.sides)
    shared, workspace = estimator.memory
    slots = sum(int(plan.slots[side, 1]) for side in choice.sides)
    views = slots + (len(choice.sides) if plan.orders else 0)
    replicate = plan.n_distinct * plan.rows * plan.width * _NUMBER
    blocks = BATCHES * len(plan.position) * min(plan.rows, BLOCKS[0]) * min(plan.columns, BLOCKS[1])
    held = len(plan.theta_deg) * views * blocks * _NUMBER
    pieces = len(plan.theta_deg) * (len(chunks(estimator.chunk)) + estimator.has_nodes)
    return {
        "result": held,
        "file": int(_WRITTEN * held),
        # Mean and scatter of what is finished, of the round at work and of its section.
        "tallies": len(plan.theta_deg) * views * 6 * replicate,
        "threads": in_flight(ReplicatedRun.waiting, threads, pieces) * estimator.chunk * slots * replicate
        + threads * workspace,
        "scratch": 4 * views * replicate,
        "estimators": shared,
    }


def _queues(plan):
    """Bytes of a `unit.Workspace`."""
    queues = 2 * len(plan.kinds)
    fields = WEIGHT + plan.n_distinct + (1 if plan.orders else 0)
    rays = queues * queue_capacity(queues) + 4 * BATCH + 2 * LANES
    return (fields * rays + N_SCRATCH * (BATCH + LANES)) * _NUMBER + len(plan.theta_deg) * _thresholds(plan)


def _thresholds(plan):
    """Bytes of the `faint.faint_weights` of one direction."""
    return 2 * len(plan.kinds) * plan.n_distinct * _NUMBER


def require_memory(scene, besides=0):
    """Make sure that the simulation of a scene fits into the memory that is free.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    besides : int
        Bytes that this process holds all the time for something else.

    Raises
    ------
    ResourceError
        With the numbers, and what would help.
    """
    if short := shortage(scene, besides):
        raise ResourceError(f"{scene.material.name}: not enough memory: {short}")


def shortage(scene, besides=0):
    """Say what is missing for the simulation of a scene, and what would help.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    besides : int
        As for `require_memory`.

    Returns
    -------
    str or None
        None if it fits, or if nothing is known of the memory.
    """
    free = free_memory()
    if free is None:
        return None
    # What this process holds already is part of the need.
    room = free[0] + resident_memory() - besides
    plan, simulation, threads = make_plan(scene), scene.simulation, threads_of(scene)
    needed = _needed(plan, simulation, threads)
    if needed.peak <= room:
        return None
    return (
        f"about {needed.peak / 1e9:.3g} GB are needed, most of them for {_PURPOSE[needed.largest]}, and "
        f"{room / 1e9:.3g} GB can be had ({free[1]}); {_remedy(plan, simulation, threads, room)}"
    )


_PURPOSE = {
    "cells": "the geometry of the cells",
    "direct": "the direct reflection of all directions",
    "tallies": "the tallies of all directions",
    "threads": "the tallies of the threads",
    "queues": "the queues of the interfaces",
    "audit": "the energy balances of the work units",
    "result": "the result",
    "file": "the file while it is written",
    "scratch": "sums of tallies",
    "estimators": "what the estimator prepares",
}


def _remedy(plan, simulation, threads, room):
    """The smallest change that makes the simulation fit: of the threads, the directions or the cells."""
    if fewer := _most(lambda n: _needed(plan, simulation, n).peak <= room, threads - 1):
        return f"{_counted(fewer, 'thread')} would fit (simulation.threads: {fewer})"
    also = "with 1 thread (simulation.threads), " if threads > 1 else ""
    orders = ", or fewer orders (simulation.orders)" if plan.orders else ""

    def fits(**changes):
        return _needed(replace(plan, **changes), simulation, 1).peak <= room

    if most := _most(lambda n: fits(theta_deg=plan.theta_deg[:n]), len(plan.theta_deg) - 1):
        return f"{also}{_counted(most, 'incident direction')} per file would fit{orders}"
    for halvings in range(1, max(plan.rows, plan.columns).bit_length()):
        rows, columns = max(1, plan.rows >> halvings), max(1, plan.columns >> halvings)
        if fits(rows=rows, columns=columns):
            return f"{also}slices of {rows} x {columns} cells would fit (slice.rows, slice.columns){orders}"
    if _needed(plan, simulation, 1).largest == "queues":
        return f"{also}give the stack fewer interfaces, or use a machine with more memory"
    return "close other programs, or use a machine with more memory"


def _counted(number, thing):
    return f"{number} {thing}{'' if number == 1 else 's'}"


def _most(fits, n):
    """Largest number up to ``n`` for which ``fits`` holds, 0 if none; it holds for all below the largest."""
    low, high = 0, n
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if fits(middle) else (low, middle - 1)
    return low
