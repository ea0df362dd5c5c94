"""The shards of a folder, traced by an executor: processes or threads of this machine, or workers of dask elsewhere."""

import contextlib
import os
import socket
import threading
import time
import uuid
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from dataclasses import dataclass
from pathlib import Path

from goniosim.cluster.division import Division
from goniosim.cluster.plan_file import NAME, ShardPlan
from goniosim.cluster.standing import State, standing_of
from goniosim.cluster.tracing import error_path, run_shard
from goniosim.errors import GoniosimError, RefusalError, StoppedError
from goniosim.writing import StrPath

# For each thread: the last of few, and of those that are harder than thought, would be waited for.
SHARDS_PER_THREAD = 4
_POLL_SECONDS = 0.2
# What was asked to stop does so in a second, and a network disk tells of it in some more.
_PATIENCE = 30.0


def shards_folder(out: StrPath) -> Path:
    """Where the shards of an output lie until they are merged: beside it."""
    path = Path(os.path.abspath(out))
    return path.with_name(f"{path.name.removesuffix('.h5')}.shards")


@dataclass(frozen=True)
class Outcome:
    """What became of a shard.

    Attributes
    ----------
    shard : int
    rays : int
        Light paths that it holds.
    done : bool
        Whether nothing is missing.
    notes : tuple of str
    """

    shard: int
    rays: int = 0
    done: bool = False
    notes: tuple[str, ...] = ()


def spread(
    folder: StrPath,
    executor: Executor,
    *,
    threads: int = 1,
    stop: threading.Event | None = None,
    every: float = 60.0,
    progress: Callable[[int, int | None], object] = lambda done, total: None,
    note: Callable[[str], object] = lambda _: None,
) -> bool:
    """Let an executor trace what is missing of the shards of a folder with a plan.

    Parameters
    ----------
    folder : path-like
        That whoever traces sees under the same name.
    executor : concurrent.futures.Executor
    threads : int
        Of each shard; executors trace several side by side.
    stop : threading.Event, optional
        When set, this ends within some seconds; what was gathered is kept.
    every : float
        Seconds between two checkpoints of a shard, at least.
    progress : callable
        Called as ``progress(done, total)`` a few times a second, with light paths of shards that are through and of
        all; None in the place of the total where a target decides.
    note : callable
        Called with a line on what was found.

    Returns
    -------
    bool
        Whether nothing is missing.

    Raises
    ------
    GoniosimError
        What the first shard that failed said; the others are traced all the same.
    """
    folder, stop = Path(os.path.abspath(folder)), stop or threading.Event()
    plan = ShardPlan.read(folder)
    before = _rays_there(plan, folder)
    rays = [Division(plan).rays(shard) for shard in before] if not plan.has_targets else None
    total = None if rays is None else sum(each or 0 for each in rays)
    known, failed = dict(before), list[GoniosimError]()
    sign = folder / f".{uuid.uuid4().hex}.stop"
    pending: dict[Future[Outcome], int] = {}
    end = None
    try:
        # Also those that seem to be through: whoever traces checks every byte.
        pending = {executor.submit(_trace, str(folder), k, threads, every, sign.name): k for k in before}
        todo = set(before)
        while pending and (end is None or time.monotonic() < end):
            progress(sum(known.values()), total)
            for future in wait(pending, timeout=_POLL_SECONDS, return_when=FIRST_COMPLETED).done:
                shard = pending.pop(future)
                try:
                    outcome = future.result()
                except GoniosimError as error:
                    failed.append(error)
                    continue
                for line in outcome.notes:
                    note(line)
                if outcome.done:
                    known[shard] = outcome.rays
                    todo.remove(shard)
            if stop.is_set() and end is None:
                _touch(sign)
                end = time.monotonic() + _PATIENCE
        progress(sum(known.values()), total)
    except (BrokenExecutor, CancelledError) as error:
        raise RefusalError(
            f"{folder}: a shard was given up: its process, or the scheduler, was ended by somebody or for want of "
            "memory; what is done stays: run this again, with fewer processes if memory is short (a script that starts "
            'processes must do so below `if __name__ == "__main__":`)'
        ) from error
    finally:
        if pending:
            _touch(sign)
        else:
            sign.unlink(missing_ok=True)
        for future in pending:
            future.cancel()
    if failed and not stop.is_set():
        raise failed[0]
    return not todo


def _touch(path: Path) -> None:
    with contextlib.suppress(OSError):
        path.touch()


def _rays_there(plan: ShardPlan, folder: Path) -> dict[int, int]:
    """Light paths of the shards that seem to be through, 0 for the others."""
    division, found = Division(plan), {}
    for shard in range(1, plan.shards + 1):
        there = [standing_of(task, folder) for task in division.tasks(shard)]
        done = all(each.state is State.DONE for each in there)
        found[shard] = sum(each.done_rays for each in there) if done else 0
    return found


def remove_shards(folder: StrPath) -> None:
    """Remove what a folder holds of its shards, and the folder if nothing else is in it.

    Parameters
    ----------
    folder : path-like
        Whose shards are merged.
    """
    plan, folder = ShardPlan.read(folder), Path(folder)
    paths = [task.path(folder) for task in Division(plan).all_tasks()]
    paths += [error_path(folder, shard, plan.shards) for shard in range(1, plan.shards + 1)]
    # The plan last: with it, what is left of an interruption is known for what it is.
    with contextlib.suppress(OSError):
        for path in [*paths, *folder.glob(".*.stop"), folder / NAME]:
            path.unlink(missing_ok=True)
        folder.rmdir()


class _Watched(threading.Event):
    """A request to stop: by a file that is looked for now and then."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._path, self._next = path, 0.0

    def is_set(self) -> bool:
        if not super().is_set() and time.monotonic() >= self._next:
            self._next = time.monotonic() + _POLL_SECONDS
            if self._path.exists():
                self.set()
        return super().is_set()


def _trace(folder: str, shard: int, threads: int, every: float, sign: str) -> Outcome:
    """Trace a shard, wherever the executor has it done."""
    if not (Path(folder) / NAME).exists():
        raise RefusalError(
            f"{folder}: {socket.gethostname()}, which is to trace a shard, does not see this folder; "
            "choose a place that all workers share"
        )
    stop, notes = _Watched(Path(folder) / sign), list[str]()
    if stop.is_set():
        return Outcome(shard)
    try:
        found = run_shard(folder, shard, threads=threads, stop=stop, every=every, note=notes.append)
    except StoppedError:
        return Outcome(shard, notes=tuple(notes))
    rays = sum(standing.done_rays for _, standing in found)
    return Outcome(shard, rays, not stop.is_set() and all(s.state is State.DONE for _, s in found), tuple(notes))
