"""All materials of a study, one after the other, each by one process."""

import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext, suppress
from functools import partial
from pathlib import Path
from typing import Any, TypeVar, overload

from ..claims import remove_dead
from ..errors import FewerRaysError, GoniosimError, OutputError, StoppedError
from ..result import Result
from ..scene import Scene, Source, as_scenes, total_rays, with_arguments
from ..sharing import Sharing
from ..store import keeper, look_at, reserve_output, result_left, state_left, write_result
from ..writing import StrPath, make_folder
from .progress import Progress, progress_of
from .simulation import check_stop, trace
from .spreading import check_executor, spread_files, spread_results
from .stopping import Stop

Study = Iterable[Scene] | Source
Kept = TypeVar("Kept")


@overload
def simulate_study(
    study: Study,
    *,
    folder: None = None,
    overwrite: bool = False,
    rays: float | None = None,
    seed: float | None = None,
    threads: int | None = None,
    estimator: str | None = None,
    target: float | str | None = None,
    of: str | None = None,
    max_rays: float | None = None,
    max_time: float | str | None = None,
    progress: Progress = None,
    stop: threading.Event | None = None,
    executor: Executor | None = None,
    shards: int | None = None,
) -> dict[str, Result]: ...


@overload
def simulate_study(
    study: Study,
    *,
    folder: StrPath,
    overwrite: bool = False,
    rays: float | None = None,
    seed: float | None = None,
    threads: int | None = None,
    estimator: str | None = None,
    target: float | str | None = None,
    of: str | None = None,
    max_rays: float | None = None,
    max_time: float | str | None = None,
    progress: Progress = None,
    stop: threading.Event | None = None,
    executor: Executor | None = None,
    shards: int | None = None,
) -> dict[str, Path]: ...


def simulate_study(
    study: Study,
    *,
    folder: StrPath | None = None,
    overwrite: bool = False,
    rays: float | None = None,
    seed: float | None = None,
    threads: int | None = None,
    estimator: str | None = None,
    target: float | str | None = None,
    of: str | None = None,
    max_rays: float | None = None,
    max_time: float | str | None = None,
    progress: Progress = None,
    stop: threading.Event | None = None,
    executor: Executor | None = None,
    shards: int | None = None,
) -> dict[str, Result] | dict[str, Path]:
    """Simulate all materials of a study.

    Ctrl-C ends the study early and returns what there is: the finished materials and, if rays of it were
    gathered, the one at work, whose status is then ``partial``. Names that are missing were not begun. With nothing at
    all, or pressed twice, it raises KeyboardInterrupt.

    Parameters
    ----------
    study : path, mapping, str or iterable of goniosim.scene.Scene
        What `load_scenes` takes, or scenes.
    folder : path-like, optional
        Write each result into ``NAME.h5`` there as soon as it is done, instead of keeping all in memory.
        Files that hold the rays or the accuracy asked for, or more, are left alone; those with less go on from what
        they hold, and the one that was at work from its last checkpoint, a minute ago at most: calling again goes on.
        Processes that simulate into one folder share the materials, and each leaves out those that others are at work
        on.
    overwrite : bool
        Leave no file alone: simulate all anew, and replace whatever results stand there.
    rays, seed, threads, estimator, target, of, max_rays, max_time, progress, stop
        As for `simulate`, and for all materials; progress is that of the whole study.
    executor : concurrent.futures.Executor, optional
        Who traces: a ProcessPoolExecutor (of processes that are spawned, not forked), a ThreadPoolExecutor, or
        ``client.get_executor(pure=False)`` of dask. The study is cut into shards, each of one thread or as many as
        ``threads`` says; the results are the same to the last bit. With ``folder`` the shards lie in
        ``FOLDER.shards``, which all workers have to see, until all are through; otherwise in the temporary directory.
        Calling again goes on with what is missing.
    shards : int, optional
        How many, for an executor: four for each core of this machine, or as many as an interrupted call made.

    Returns
    -------
    dict of str to goniosim.result.Result, or of str to Path
        By the name of the material, in the order of the study: the results, or with ``folder`` their files,
        those left alone included, and those that other processes are at work on left out.

    Raises
    ------
    goniosim.errors.ConfigError
        The study, or one of the other arguments, is wrong.
    goniosim.errors.OutputError
        A file cannot be written; found before the first ray is traced where possible.
    goniosim.errors.StoppedError
        ``stop`` was set before there was anything to keep.
    KeyboardInterrupt
        Ctrl-C before there was anything to keep, or pressed twice.

    Examples
    --------
    >>> results = goniosim.simulate_study("study.yaml", rays=1e4)
    >>> list(results)
    ['coat-0.1', 'coat-0.2', 'coat-0.3']
    >>> goniosim.simulate_study("study.yaml", rays=1e4, folder="coats")["coat-0.2"].name
    'coat-0.2.h5'
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(2) as executor:
    ...     results = goniosim.simulate_study("study.yaml", rays=1e4, executor=executor)
    """
    given = {
        "rays": rays,
        "seed": seed,
        "threads": threads,
        "estimator": estimator,
        "target": target,
        "of": of,
        "max_rays": max_rays,
        "max_time": max_time,
    }
    scenes = [with_arguments(scene, given) for scene in as_scenes(study)]
    check_stop(stop)
    check_executor(executor, shards)
    if folder is None and executor is not None:
        return spread_results(scenes, executor, shards, progress, stop)
    if folder is None:
        results: dict[str, Result] = {}
        _run(scenes, trace, results, progress, stop)
        return results
    paths = {scene.material.name: Path(folder) / f"{scene.material.name}.h5" for scene in scenes}
    make_folder(folder)
    remove_dead(paths.values())
    files = {name: paths[name] for name in ([] if overwrite else _finished(scenes, paths))}
    todo = [scene for scene in scenes if scene.material.name not in files]
    for scene in todo:
        # Room is kept only for the material at work.
        reserve_output(paths[scene.material.name], 0).release()
    if executor is not None:
        spread_files(scenes, files, folder, overwrite, executor, shards, progress, stop)
        return {name: files[name] for name in paths if name in files}
    sharing = Sharing(todo, lambda scene: paths[scene.material.name], partial(_is_done, paths, overwrite))
    _run(todo, partial(_into_file, paths, overwrite, sharing), files, progress, stop, sharing)
    files.update((scene.material.name, paths[scene.material.name]) for scene in sharing.finished)
    return {name: files[name] for name in paths if name in files}


def _run(
    scenes: Sequence[Scene],
    one: Callable[[Scene, str, Any, Stop], Kept],
    kept: dict[str, Kept],
    progress: Progress,
    stop: threading.Event | None,
    sharing: Sharing[Scene] | None = None,
) -> None:
    """Add ``one(scene, label, shown, asked)`` of each scene to what is kept, until somebody asks to stop.

    Of each scene that there is to do, if they are shared with other processes.
    """
    with progress_of(progress, total_rays(scenes)) as shown, Stop(stop) as asked:
        asked.gathering = bool(kept)
        for number, scene, claim in sharing or ((*each, nullcontext()) for each in enumerate(scenes, 1)):
            name = scene.material.name
            with claim:
                if sharing is not None:
                    shown.pass_over(total_rays([*sharing.finished, *(each for each, _ in sharing.owners)]))
                try:
                    kept[name] = one(scene, f"{number}/{len(scenes)} {name}", shown, asked)
                except StoppedError:
                    # An error only if there is nothing from the materials before it either.
                    if not kept and asked.interrupted:
                        raise KeyboardInterrupt from None
                    if not kept:
                        raise
            if asked.is_set():
                return


def _into_file(
    paths: Mapping[str, Path],
    overwrite: bool,
    sharing: Sharing[Scene],
    scene: Scene,
    label: str,
    shown: Any,
    asked: Stop,
) -> Path:
    from ..report.simulation.forecast import file_size

    path = paths[scene.material.name]
    # What others left of it since is no result to be replaced.
    anew = overwrite and sharing.is_untouched(scene)
    with reserve_output(path, file_size(scene)) as reservation:
        left = {} if anew else _left(path, scene)
        result = trace(scene, label, shown, asked, checkpoint=keeper(path, overwrite), **left)
        # Ended early it may have fewer rays than an earlier file, which then stays.
        with suppress(FewerRaysError):
            write_result(result, path, overwrite=overwrite, reservation=reservation)
    return path


def _is_done(paths: Mapping[str, Path], overwrite: bool, scene: Scene, untouched: bool) -> bool:
    if not overwrite:
        return bool(_finished([scene], paths))
    found = None if untouched else look_at(paths[scene.material.name], scene)
    return found is not None and found.holds(scene.simulation)


def _left(path: Path, scene: Scene) -> dict[str, Any]:
    """What a run goes on from, as the engine takes it; empty if there is nothing of it, or of another version."""
    from ..engine import checked_state, prior_of

    try:
        if left := state_left(path, scene):
            checked_state(left[0])
            return {"resume": left[0]}
        if result := result_left(path, scene):
            return {"prior": prior_of(scene, result)}
    except GoniosimError:
        pass
    return {}


def _finished(scenes: Iterable[Scene], paths: Mapping[str, Path]) -> list[str]:
    """Names of the scenes whose files hold what is asked for; an OutputError if one holds another scene."""
    finished, others = [], []
    for scene in scenes:
        name = scene.material.name
        found = look_at(paths[name], scene)
        if found is not None and found.differences:
            others.append(f"{paths[name]}: holds the result of another scene ({'; '.join(found.differences)})")
        if found is not None and found.holds(scene.simulation):
            finished.append(name)
    if others:
        raise OutputError(
            f"{others[0]}, so it is not overwritten; choose another folder, or overwrite=True", others[1:]
        )
    return finished
