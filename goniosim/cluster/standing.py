"""What there is of a task: nothing, something damaged, some of it, or all."""

from dataclasses import dataclass
from enum import Enum

from goniosim.cluster.division import Task
from goniosim.errors import DamagedFileError, GoniosimError, OutputError
from goniosim.store import Portion, look_at, read_portion
from goniosim.writing import StrPath


class State(Enum):
    """How far a task is."""

    MISSING = "missing"
    DAMAGED = "damaged"
    PARTIAL = "partial"
    DONE = "done"


@dataclass(frozen=True)
class Standing:
    """What stands at the place of a task.

    Attributes
    ----------
    state : State
    done_rays, total_rays : int
        Light paths that it holds and that it should hold; 0 where nobody knows.
    why : str
        What is wrong with it, if it is damaged.
    seconds : float
        That were spent on it.
    noise : float or None
        Largest noise of a slice in the directions that it has begun, in sr^-1/2.
    """

    state: State
    done_rays: int = 0
    total_rays: int = 0
    why: str = ""
    seconds: float = 0.0
    noise: float | None = None


def standing_of(task: Task, folder: StrPath, *, whole: bool = False) -> Standing:
    """See what stands at the place of a task.

    Parameters
    ----------
    task : Task
    folder : path-like
    whole : bool
        Whether every byte is checked.

    Returns
    -------
    Standing

    Raises
    ------
    OutputError
        If something else stands there, which nobody may remove unasked.
    """
    return _of_result(task, folder) if task.is_result else _of_portion(task, folder, whole)


def _of_portion(task: Task, folder: StrPath, whole: bool) -> Standing:
    path = task.path(folder)
    if not path.exists():
        return Standing(State.MISSING)
    try:
        found, _ = read_portion(path, whole=whole)
    except DamagedFileError as error:
        return Standing(State.DAMAGED, why=str(error))
    except GoniosimError as error:
        raise OutputError(f"{error}; it stands in the place of a shard and is left alone: remove it") from error
    if why := misfit(task, found):
        raise OutputError(f"{path}: {why}; it is left alone: remove it, or choose another folder")
    state = State.DONE if found.is_whole else State.PARTIAL
    return Standing(
        state,
        found.done_rays,
        found.total_rays,
        seconds=found.milliseconds / 1000.0,
        noise=float(found.noise) if found.noise else None,
    )


def misfit(task: Task, found: Portion) -> str:
    """What a portion differs in from that of a task; nothing if it is it."""
    if found.config_yaml != task.scene.to_yaml():
        return "is of another scene"
    if (found.shard, found.shards) != (task.shard, task.shards):
        return f"is shard {found.shard} of {found.shards}, and not {task.shard} of {task.shards}"
    if (found.first, found.end) != (task.first, task.end):
        return "holds other pieces of work: the plan was changed since"
    return ""


def _of_result(task: Task, folder: StrPath) -> Standing:
    path = task.path(folder)
    found = look_at(path, task.scene)
    if found is None:
        return Standing(State.MISSING)
    if found.damage:
        return Standing(State.DAMAGED, why=found.damage)
    if found.differences or found.rays is None:
        raise OutputError(f"{path}: holds the result of another scene; it is left alone: remove it")
    rays = int(found.rays.sum())
    if not found.holds(task.scene.simulation):
        return Standing(State.PARTIAL, rays)
    return Standing(State.DONE, rays, rays)
