"""What a study will take as a job array: time, memory and disk, and so into how many shards to cut it."""

import math
from dataclasses import dataclass

from goniosim.cluster.division import Division
from goniosim.cluster.plan_file import ShardPlan
from goniosim.cores import available_cores
from goniosim.engine import memory_needed, piece_rays
from goniosim.engine.pieces import pieces_of, start
from goniosim.engine.plan import make_plan
from goniosim.report.simulation.forecast import file_size, forecasts, size_of_batches

# Of its time a shard fills about this share: predictions are of this machine, and others are slower.
FILL = 0.6
# Seconds that a shard takes to start, and a multiple of them that its work should take.
START_UP, WORTH = 2.0, 30.0
# Slurm's usual limit on the numbers of an array is 1000.
MOST = 1000
# Measured: bytes of a file of a shard, and of each sum in it, besides what is in cells.
_FILE, _RECORD = 16_000, 8_000
# Tasks of fewer processors find their place sooner.
MOST_CPUS = 8


@dataclass(frozen=True)
class Expected:
    """What a material takes in a task.

    Attributes
    ----------
    scene : goniosim.scene.Scene
    rays_per_second : float
        On all processors of a task.
    seconds : float or None
        With a target the most that its limits allow, None without such limits.
    n_bytes : int
        Memory, an upper estimate.
    file_bytes : int
        Of its result, an upper estimate.
    shortage : str or None
        What is missing if the memory is more than is free here.
    """

    scene: object
    rays_per_second: float
    seconds: float | None
    n_bytes: int
    file_bytes: int
    shortage: str | None


def usual_cpus():
    """Processors of a task, if nobody asks for others: those of this machine, unless they are many."""
    return min(available_cores(), MOST_CPUS)


def expect(scenes, cpus):
    """Probe the speed of every scene for a moment.

    Parameters
    ----------
    scenes : list of goniosim.scene.Scene
    cpus : int
        Of a task.

    Returns
    -------
    list of Expected
    """
    here = min(cpus, available_cores())
    made = forecasts([_on(scene, here) for scene in scenes])
    found = []
    for scene, one in zip(scenes, made, strict=True):
        memory = memory_needed(_on(scene, cpus))
        asked = scene.simulation
        # The time that a target may take is the same on any number of processors, the rays are not.
        traced = None if one.seconds is None or one.seconds == asked.max_time else one.seconds * here / cpus
        seconds = min(filter(None, (traced, asked.max_time)), default=None)
        rate = one.rays_per_second * cpus / here
        found.append(Expected(scene, rate, seconds, memory.peak + memory.checkpoint, file_size(scene), one.shortage))
    return found


def _on(scene, threads):
    return scene.model_copy(update={"simulation": scene.simulation.model_copy(update={"threads": threads})})


@dataclass(frozen=True)
class Outlook:
    """A study as a job array, and what it takes.

    Attributes
    ----------
    plan : goniosim.cluster.plan_file.ShardPlan
        Shards that take equally long.
    expected : list of Expected
    cpus : int
        Of a task.
    walltime : float
        Seconds that a task may take.
    """

    plan: ShardPlan
    expected: list
    cpus: int
    walltime: float

    @property
    def seconds(self):
        """Of all tasks together, those whose time nobody knows taken for the mean of the others."""
        return sum(_weights(self.expected)) + START_UP * self.plan.shards

    @property
    def each(self):
        """Seconds of a shard."""
        return self.seconds / self.plan.shards

    @property
    def n_bytes(self):
        """Memory of a task, an upper estimate."""
        return max(one.n_bytes for one in self.expected)

    @property
    def disk(self):
        """Bytes that the shards leave and that the results take, upper estimates."""
        return _left(self.plan), sum(one.file_bytes for one in self.expected)


def look_ahead(scenes, study, *, cpus, walltime, shards=None):
    """Predict what a study takes as a job array.

    Parameters
    ----------
    scenes : list of goniosim.scene.Scene
    study : str or None
    cpus : int
        Of a task.
    walltime : float
        Seconds that a task may take.
    shards : int, optional
        By default so many that each fits well into its time.

    Returns
    -------
    Outlook
    """
    expected = expect(scenes, cpus)
    if shards is None:
        shards = _recommended(expected, walltime)
    return Outlook(ShardPlan.make(scenes, study, shards, _weights(expected)), expected, cpus, walltime)


def _recommended(expected, walltime):
    seconds = sum(_weights(expected))
    wanted = math.ceil(seconds / (FILL * walltime))
    worth = int(seconds / (WORTH * START_UP))
    pieces = sum(1 if one.scene.simulation.target else len(piece_rays(one.scene)) for one in expected)
    return max(1, min(wanted, worth, pieces, MOST))


def _weights(expected):
    known = [one.seconds for one in expected if one.seconds is not None]
    usual = sum(known) / len(known) if known else 1.0
    return [usual if one.seconds is None else one.seconds for one in expected]


def _left(plan):
    """Bytes of the files of all shards, at most."""
    pieces, sums, total = {}, {}, 0.0
    for task in Division(plan).all_tasks():
        if task.is_result:
            continue
        scene, name = task.scene, task.scene.material.name
        if name not in pieces:
            pieces[name] = pieces_of(start(make_plan(scene), scene.simulation)[1], scene.simulation.rays)
            of_all = memory_needed(scene).tallies + size_of_batches(scene)
            sums[name] = of_all / len(scene.incident.theta_deg) + _RECORD
        total += _records(pieces[name][task.first : task.end]) * sums[name] + _FILE
    return int(total)


def _records(pieces):
    """Sums that a portion of these keeps: one of each direction that it begins, and of each piece of the others."""
    begun = {(piece.run, piece.direction) for piece in pieces if piece.number == 0}
    return len(begun) + sum((piece.run, piece.direction) not in begun for piece in pieces)
