"""A study in shards that an executor traces, joined to what would have come of it without."""

import tempfile
import threading
from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path

from ..cores import available_cores
from ..errors import ConfigError, StoppedError
from ..result import Result
from ..scene import Scene, total_rays
from ..writing import StrPath
from .progress import Progress, progress_of
from .stopping import Stop

_STUDY = "study"


def check_executor(executor: object, shards: object) -> None:
    """Raise a ConfigError for anything but an executor, and a number of shards for it."""
    problems = []
    if executor is not None and not isinstance(executor, Executor):
        problems.append(f"executor must be a concurrent.futures.Executor [got {executor!r}]")
    if executor is None and shards is not None:
        problems.append("shards are for an executor: give one, or leave them out")
    if shards is not None and (not isinstance(shards, int) or isinstance(shards, bool)):
        problems.append(f"shards must be a whole number [got {shards!r}]")
    if problems:
        raise ConfigError(problems)


def spread_results(
    scenes: Sequence[Scene], executor: Executor, shards: int | None, progress: Progress, stop: threading.Event | None
) -> dict[str, Result]:
    """Results of scenes by their names; of what there is, if it is stopped."""
    from ..cluster import merge

    with tempfile.TemporaryDirectory(prefix="goniosim-", ignore_cleanup_errors=True) as folder, Stop(stop) as asked:
        whole = _spread(scenes, Path(folder), executor, shards, progress, asked)
        found = merge(folder, Path(folder) / "merged", allow_missing=not whole, threads=_threads(scenes))
        results = {result.name: result for result, _ in found}
        if not results:
            raise _stopped(asked)
        return results


def spread_files(
    scenes: Sequence[Scene],
    files: dict[str, Path],
    folder: StrPath,
    overwrite: bool,
    executor: Executor,
    shards: int | None,
    progress: Progress,
    stop: threading.Event | None,
) -> None:
    """Add the files of all scenes that have none yet; their shards lie beside the folder until they are merged."""
    from ..cluster import ShardPlan, merge, remove_shards, shards_folder

    if len(files) == len(scenes):
        return
    beside = shards_folder(folder)
    # With those that were missing when a call began that was interrupted.
    there = ShardPlan.find(beside)
    begun = {scene.material.name for scene in there.scenes} if there is not None else set()
    chosen = [scene for scene in scenes if scene.material.name in begun or scene.material.name not in files]
    with Stop(stop) as asked:
        if not _spread(chosen, beside, executor, shards, progress, asked):
            if not files:
                raise _stopped(asked)
            return
        found = merge(beside, folder, overwrite=overwrite, threads=_threads(scenes))
        files.update({result.name: path for result, path in found})
    remove_shards(beside)


def _spread(
    scenes: Sequence[Scene],
    folder: Path,
    executor: Executor,
    shards: int | None,
    progress: Progress,
    asked: Stop,
) -> bool:
    """Trace the shards of a folder; whether all are through."""
    from ..cluster import ShardPlan, plan_of, spread
    from ..cluster.spreading import SHARDS_PER_THREAD

    if shards is None:
        there = ShardPlan.find(folder)
        shards = there.shards if there is not None else SHARDS_PER_THREAD * available_cores()
    plan = plan_of(folder, ShardPlan.make(scenes, _STUDY, shards))
    whole = total_rays(scenes)
    with progress_of(progress, whole) as shown:

        def report(done: int, total: int | None) -> None:
            # Of shards, with the work on further components, told in rays of the scenes.
            done = done if total is None or whole is None else whole * done // max(total, 1)
            if not asked.gathering:
                asked.gathering = True
                shown.begin(f"{plan.shards} shards", inherited=done)
            shown.update(done, whole)

        return bool(spread(folder, executor, threads=_threads(scenes) or 1, stop=asked, progress=report))


def _threads(scenes: Sequence[Scene]) -> int | None:
    return scenes[0].simulation.threads


def _stopped(asked: Stop) -> BaseException:
    return KeyboardInterrupt() if asked.interrupted else StoppedError("stopped before there was anything to return")
