"""One shard: its tasks traced one after the other, each into a file of its own."""

import contextlib
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from goniosim.claims import Claim
from goniosim.cluster.claimed import claimed
from goniosim.cluster.division import Division, Task
from goniosim.cluster.plan_file import ShardPlan
from goniosim.cluster.standing import Standing, State, standing_of
from goniosim.engine import Traced, checked_state, simulate, trace_portion
from goniosim.errors import (
    DamagedFileError,
    FewerRaysError,
    GoniosimError,
    InUseError,
    OutputError,
    StoppedError,
    UnreadableFileError,
    UnusableResultError,
)
from goniosim.provenance import provenance
from goniosim.scene import Scene, with_arguments
from goniosim.store import Portion, keeper, read_portion, state_left, write_portion, write_result
from goniosim.writing import StrPath, explained, replacing

Progress = Callable[[int, int | None], object]


def error_path(folder: StrPath, shard: int, shards: int) -> Path:
    """Where a shard that ended with an error says so."""
    return Path(folder) / f"shard-{shard:05d}-of-{shards:05d}.error"


def run_shard(
    folder: StrPath,
    shard: int,
    *,
    threads: int | None = None,
    stop: threading.Event | None = None,
    every: float = 60.0,
    begin: Callable[[Task, Claim], Progress | None] = lambda *_: None,
    note: Callable[[str], object] = lambda _: None,
) -> list[tuple[Task, Standing]]:
    """Trace what is missing of a shard of a folder with a plan.

    Parameters
    ----------
    folder : path-like
    shard : int
        From 1 on.
    threads : int, optional
        By default all that this process may use.
    stop : threading.Event, optional
        When set, this ends within about a second; what was gathered is kept.
    every : float
        Seconds between two checkpoints, at least.
    begin : callable
        Called with each task that is begun and the claim on its file; returns what to call as
        ``progress(done_rays, total_rays)``, if anything.
    note : callable
        Called with a line on what was found.

    Returns
    -------
    list of (Task, Standing)
        What stands at the end, of all tasks that were begun or are done.

    Raises
    ------
    OutputError
        If a file cannot be written, something else stands in its place, or another process is at work on it.
    StoppedError
        If it was stopped before there was anything to keep.
    """
    plan, stop = ShardPlan.read(folder), stop or threading.Event()
    plan.require_version(folder)
    failure = error_path(folder, shard, plan.shards)
    failure.unlink(missing_ok=True)
    found: list[tuple[Task, Standing]] = []
    try:
        for task in Division(plan).tasks(shard):
            with explained(task.path(folder)), claimed(task.path(folder), stop, note) as claim:
                # Every byte: what is damaged is made anew, as `merge` asks for.
                before = standing_of(task, folder, whole=True)
                if before.state is State.DAMAGED:
                    note(f"to be replaced: {before.why}")
                if before.state is not State.DONE:
                    if stop.is_set():
                        break
                    before = _trace(task, folder, threads, stop, every, begin(task, claim), note)
            found.append((task, before))
    except StoppedError:
        if not found:
            raise
    except InUseError:
        # No failure of whoever is at work on it.
        raise
    except GoniosimError as error:
        # A disk that is full takes no word on it either.
        with contextlib.suppress(OutputError), replacing(failure) as temporary:
            temporary.write_text(" ".join(str(error).split()) + "\n", encoding="utf-8")
        raise
    return found


def _trace(
    task: Task,
    folder: StrPath,
    threads: int | None,
    stop: threading.Event,
    every: float,
    progress: Progress | None,
    note: Callable[[str], object],
) -> Standing:
    scene = with_arguments(task.scene, {"threads": threads})
    trace = _trace_result if task.is_result else _trace_portion
    return trace(task, scene, folder, note, progress=progress, stop=stop, every=every)


def _trace_portion(task: Task, scene: Scene, folder: StrPath, note: Callable[[str], object], **given: Any) -> Standing:
    assert task.first is not None and task.end is not None
    path, began = task.path(folder), time.monotonic()
    resume, before = _left(path, note)

    def keep(traced: Traced, rescued: bool = False) -> Standing:
        known, milliseconds = provenance(1), before + round(1000.0 * (time.monotonic() - began))
        portion = Portion(
            goniosim_version=known["goniosim_version"],
            created_utc=known["created_utc"],
            name=task.scene.material.name,
            config_yaml=task.scene.to_yaml(),
            config_hash=task.scene.config_hash(),
            shard=task.shard,
            shards=task.shards,
            first=task.first or 0,
            end=task.end or 0,
            done_rays=traced.done_rays,
            total_rays=traced.total_rays,
            milliseconds=milliseconds,
            noise="" if traced.noise is None else f"{traced.noise:.4g}",
        )
        write_portion(portion, traced.state, path, rescued=rescued)
        state = State.DONE if portion.is_whole else State.PARTIAL
        return Standing(state, traced.done_rays, traced.total_rays, seconds=milliseconds / 1000.0, noise=traced.noise)

    def checkpoint(traced: Traced) -> None:
        try:
            keep(traced)
        except OutputError as error:
            note(f"no checkpoint: {error}")

    try:
        traced = trace_portion(scene, task.first, task.end, checkpoint=checkpoint, resume=resume, **given)
    except UnusableResultError as error:
        # No accident: its digests were right.
        raise UnusableResultError(f"{path}: {error}; remove it, to begin anew") from error
    return keep(traced, rescued=True)


def _left(path: Path, note: Callable[[str], object]) -> tuple[bytes | None, int]:
    """State and milliseconds of an interrupted shard."""
    if not path.exists():
        return None, 0
    try:
        portion, state = read_portion(path)
        checked_state(state)
    except UnreadableFileError:
        raise
    except DamagedFileError:
        # Of which there was a word already.
        return None, 0
    except GoniosimError as error:
        note(f"{path}: begins anew: {error}")
        return None, 0
    note(f"{path}: goes on from {100.0 * portion.done_rays / portion.total_rays:.3g} % of its light paths")
    return state, portion.milliseconds


def _trace_result(task: Task, scene: Scene, folder: StrPath, note: Callable[[str], object], **given: Any) -> Standing:
    path = task.path(folder)
    resume = None
    if left := state_left(path, scene):
        try:
            checked_state(left[0])
            resume = left[0]
        except UnusableResultError as error:
            note(f"{path}: begins anew: {error}")

    def failed(error: OutputError) -> None:
        note(f"no checkpoint: {error}")

    keep = keeper(path, failed=failed)
    result = simulate(scene, checkpoint=keep, resume=resume, **given)
    with contextlib.suppress(FewerRaysError):
        write_result(result, path)
    return standing_of(task, folder)
