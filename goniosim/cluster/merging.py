"""All shards of a folder joined: to the results of one plain run."""

import shlex
import threading
from collections.abc import Callable, Collection, Iterator
from pathlib import Path

from goniosim.cluster.claimed import claimed
from goniosim.cluster.division import Division, Task
from goniosim.cluster.plan_file import ShardPlan
from goniosim.cluster.shard import array_list
from goniosim.cluster.standing import Standing, State, standing_of
from goniosim.engine import join_portions
from goniosim.errors import ConfigError, OutputError, UnusableResultError
from goniosim.result import Result
from goniosim.scene import with_arguments
from goniosim.store import open_result, read_portion, write_result
from goniosim.writing import StrPath, explained, make_folder

_WORDS = {State.MISSING: "missing", State.PARTIAL: "not finished"}


def merge(
    folder: StrPath,
    out: StrPath,
    *,
    allow_missing: bool = False,
    overwrite: bool = False,
    only: Collection[str] = (),
    threads: int | None = None,
    note: Callable[[str], object] = lambda _: None,
) -> Iterator[tuple[Result, Path]]:
    """Join all shards of a folder.

    Everything is looked at before anything is written.

    Parameters
    ----------
    folder : path-like
        With a plan and what its shards have traced.
    out : path-like
        Result file, or the folder of a study's files.
    allow_missing : bool
        Join what is there; the results say what is missing, and have the status ``partial``.
    overwrite : bool
        Replace results of other scenes, or with more rays.
    only : collection of str
        Names of materials, so that several processes can share the work; all without.
    threads : int, optional
    note : callable
        Called with a line on what is left out.

    Yields
    ------
    Result, Path
        Of each material, once its file stands.

    Raises
    ------
    ForeignFileError
        If there is no plan in the folder.
    UnusableResultError
        If shards are missing, not finished, damaged, there twice, or of another version of goniosim; it names those to
        run again.
    OutputError
        If a file cannot be written, another process is at work on it, or something else stands in the place of a shard.
    """
    plan = ShardPlan.read(folder)
    plan.require_version(folder)
    if unknown := set(only) - {scene.material.name for scene in plan.scenes}:
        raise ConfigError(f"{folder}: has no material {sorted(unknown)[0]}")
    tasks = Division(plan).all_tasks()
    _refuse_others(folder, tasks)
    tasks = [task for task in tasks if not only or task.scene.material.name in only]
    lacking = _lacking(tasks, folder)
    if lacking and not allow_missing:
        raise _incomplete(folder, lacking)
    for task, there in lacking.items():
        what = "used as far as it goes" if there.state is State.PARTIAL else "left out"
        note(f"{what}: {_line(task, there, folder)}")
    make_folder(out if plan.study is not None else Path(out).parent)
    words = f"{len({task.shard for task in tasks})} shards"
    if lacking:
        words += f", of which {array_list([task.shard for task in lacking])} are missing or not finished"
    for scene in plan.scenes:
        mine = [task for task in tasks if task.scene is scene]
        usable = [task for task in mine if task not in lacking or lacking[task].state is State.PARTIAL]
        if not mine:
            continue
        if not usable:
            note(f"left out: {scene.material.name}: nothing of it is there")
            continue
        path = Path(out) / f"{scene.material.name}.h5" if plan.study is not None else Path(out)
        with explained(path), claimed(path, threading.Event(), note):
            result = _joined(usable, folder, threads)
            if result.status != "complete" and lacking.keys().isdisjoint(mine):
                raise UnusableResultError(
                    f"{folder}: {scene.material.name}: its shards hold less than they say; run all again"
                )
            result.provenance["merged"] = words
            # Nothing is lost if it cannot be written: the shards are there.
            write_result(result, path, overwrite=overwrite, rescued=False)
        yield result, path


def _joined(tasks: list[Task], folder: StrPath, threads: int | None) -> Result:
    if tasks[0].is_result:
        return open_result(tasks[0].path(folder))
    scene = with_arguments(tasks[0].scene, {"threads": threads})
    try:
        result: Result = join_portions(scene, (read_portion(task.path(folder))[1] for task in tasks))
    except UnusableResultError as error:
        number = getattr(error, "number", None)
        if number is None:
            raise
        task = tasks[number]
        raise UnusableResultError(f"{task.path(folder)}: {error}; run its shard again: --array={task.shard}") from error
    # As of a plain run that leaves the threads to the machine.
    result.config_yaml = tasks[0].scene.to_yaml()
    return result


def _lacking(tasks: list[Task], folder: StrPath) -> dict[Task, Standing]:
    """Tasks that are not done, with what there is of them."""
    found = ((task, standing_of(task, folder, whole=True)) for task in tasks)
    return {task: there for task, there in found if there.state is not State.DONE}


def _line(task: Task, there: Standing, folder: StrPath) -> str:
    return there.why or f"{task.path(folder)}: {_WORDS[there.state]}"


def _incomplete(folder: StrPath, lacking: dict[Task, Standing]) -> UnusableResultError:
    shards = array_list([task.shard for task in lacking])
    lines = [_line(task, there, folder) for task, there in lacking.items()]
    shown = [*lines[:20], *([f"and {len(lines) - 20} more"] if len(lines) > 20 else [])]
    hand = f"goniosim simulate {shlex.quote(str(folder))} --shard {next(iter(lacking)).shard}"
    count = f"{len(lines)} of its files are" if len(lines) > 1 else "one of its files is"
    return UnusableResultError(
        f"{folder}: {count} missing, not finished or damaged, and nothing was written; run these shards again: "
        f"--array={shards} (by hand: {hand}), or merge what is there with --allow-missing",
        shown,
    )


def _refuse_others(folder: StrPath, tasks: list[Task]) -> None:
    """What belongs to another division of the same work would count twice."""
    expected = {task.name for task in tasks}
    others = sorted(path.name for path in Path(folder).glob("*.shard-*-of-*.h5") if path.name not in expected)
    if others:
        more = f" and {len(others) - 3} more" if len(others) > 3 else ""
        raise OutputError(
            f"{folder}: {', '.join(others[:3])}{more}: of another division of the work; remove what is not to be merged"
        )
