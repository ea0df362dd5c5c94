"""How far the shards of a folder are: done, running, stopped, missing, or failed with what they said."""

from dataclasses import dataclass
from enum import Enum
from functools import cache
from pathlib import Path

from goniosim.claims import owner_of
from goniosim.cluster.division import Division
from goniosim.cluster.plan_file import ShardPlan
from goniosim.cluster.standing import Standing, State, standing_of
from goniosim.cluster.tracing import error_path
from goniosim.engine import piece_rays
from goniosim.errors import OutputError

# Of what a shard says of its error.
_LONGEST = 2000


class Stage(Enum):
    """How far a shard is."""

    DONE = "done"
    RUNNING = "running"
    STOPPED = "stopped"
    MISSING = "missing"
    FAILED = "failed"


@dataclass(frozen=True)
class Shard:
    """How far one shard is.

    Attributes
    ----------
    number : int
        From 1 on.
    stage : Stage
    done_rays, total_rays : int
        Light paths that it holds, and that it should hold; without scenes where a target decides how many.
    done_work, total_work : float
        The same in units of predicted time, with all scenes.
    seconds : float
        Spent on what it holds.
    noise : float or None
        Largest noise of a slice in the directions that it has begun, in sr^-1/2.
    why : str
        What went wrong, if something did.
    """

    number: int
    stage: Stage
    done_rays: int
    total_rays: int
    done_work: float
    total_work: float
    seconds: float
    noise: float | None
    why: str


@dataclass(frozen=True)
class Status:
    """How far all shards of a folder are.

    Attributes
    ----------
    plan : ShardPlan
    shards : list of Shard
    """

    plan: ShardPlan
    shards: list

    def of(self, *stages):
        """The shards that are so far."""
        return [shard for shard in self.shards if shard.stage in stages]

    @property
    def noise(self):
        """Largest noise of a slice in the directions that were begun, in sr^-1/2; None if nobody knows."""
        return max((shard.noise for shard in self.shards if shard.noise is not None), default=None)

    def seconds_left(self, shards):
        """Seconds that some shards still take, one after the other.

        Parameters
        ----------
        shards : list of Shard

        Returns
        -------
        float or None
            At the rate of what is done of all; None as long as that says nothing.
        """
        left = sum(shard.total_work - shard.done_work for shard in shards)
        if left <= 0.0:
            return 0.0
        timed = [shard for shard in self.shards if shard.seconds > 0]
        work = sum(shard.done_work for shard in timed)
        return left * sum(shard.seconds for shard in timed) / work if work > 0.0 else None


def look(folder, *, whole=False):
    """See how far the shards of a folder are.

    Parameters
    ----------
    folder : path-like
        With a plan.
    whole : bool
        Whether every byte is checked, so that what a disk has damaged counts as failed.

    Returns
    -------
    Status

    Raises
    ------
    ForeignFileError
        If there is no plan.
    """
    plan = ShardPlan.read(folder)
    division, weight = Division(plan), dict(zip(map(id, plan.scenes), plan.weights, strict=True))
    rays_of = cache(lambda number: piece_rays(plan.scenes[number]))
    places = {id(scene): number for number, scene in enumerate(plan.scenes)}

    def parts(task):
        """Light paths and work of a task."""
        if task.is_result:
            return 0, weight[id(task.scene)]
        rays = rays_of(places[id(task.scene)])
        mine = sum(rays[task.first : task.end])
        return mine, weight[id(task.scene)] * mine / sum(rays)

    found = [_shard(number, division.tasks(number), folder, plan, parts, whole) for number in range(1, plan.shards + 1)]
    return Status(plan, found)


def _shard(number, tasks, folder, plan, parts, whole):
    standings = [_standing(task, folder, whole) for task in tasks]
    sizes = [parts(task) for task in tasks]
    done_rays, done_work, seconds = 0, 0.0, 0.0
    for task, standing, (rays, work) in zip(tasks, standings, sizes, strict=True):
        share = float(standing.state is State.DONE)
        if not task.is_result and standing.total_rays:
            share = standing.done_rays / standing.total_rays
            seconds += standing.seconds
        done_rays += round(share * rays)
        done_work += share * work
    failed, why = _failure(folder, number, plan.shards)
    damaged = next((standing.why for standing in standings if standing.state is State.DAMAGED), "")
    if all(standing.state is State.DONE for standing in standings):
        stage = Stage.DONE
    elif any(owner_of(task.path(folder)) for task in tasks):
        stage = Stage.RUNNING
    elif failed or damaged:
        stage = Stage.FAILED
    elif any(standing.state is not State.MISSING for standing in standings):
        stage = Stage.STOPPED
    else:
        stage = Stage.MISSING
    total_rays, total_work = sum(rays for rays, _ in sizes), sum(work for _, work in sizes)
    noise = max((standing.noise for standing in standings if standing.noise is not None), default=None)
    shown = (why or damaged) if stage is Stage.FAILED else ""
    return Shard(number, stage, done_rays, total_rays, done_work, total_work, seconds, noise, shown)


def _standing(task, folder, whole):
    try:
        return standing_of(task, folder, whole=whole)
    except OutputError as error:
        # Of somebody else: a word on it, and on with the other shards.
        return Standing(State.DAMAGED, why=str(error))


def _failure(folder, number, shards):
    """Whether a shard ended with an error, and what it said."""
    try:
        said = Path(error_path(folder, number, shards)).read_text(encoding="utf-8", errors="replace")
    except FileNotFoundError:
        return False, ""
    except OSError as error:
        return True, error.strerror or "its error cannot be read"
    return True, " ".join(said[:_LONGEST].split()) or "it says nothing"
