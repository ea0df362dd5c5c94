"""The materials of one command, one after the other: reserve, compile, simulate, write."""

import os
import threading
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from goniosim import claims, parts
from goniosim.errors import FewerRaysError, GoniosimError, OutputError, StoppedError, UnusableResultError
from goniosim.sharing import Sharing
from goniosim.writing import make_folder

from .sharing import leave_to_others, rays_of_others

# Kernels from the cache load faster than this; a longer wait deserves a word.
PATIENCE = 1.0
_REMEDY = "nothing is overwritten: choose another place with -o, or replace results with --overwrite"


@dataclass(frozen=True)
class Job:
    """A scene and the file its result goes to, of a study with others."""

    scene: object
    path: Path
    of_study: bool = False

    @property
    def name(self):
        """Name of the material."""
        return self.scene.material.name

    def is_finished(self, standing):
        """Whether a `goniosim.store.Standing`, if there is one, holds what is asked for."""
        return standing is not None and standing.holds(self.scene.simulation)

    def reserve(self):
        """Make sure that the file can be written, and keep room for it."""
        from goniosim.report.simulation.forecast import file_size
        from goniosim.store import reserve_output

        return reserve_output(self.path, file_size(self.scene))


def plan(scenes, output, folder):
    """Pair the scenes with their files.

    Parameters
    ----------
    scenes : list of Scene
    output : str or None
        As given by the user, for a single material.
    folder : Path or None
        For a study.

    Returns
    -------
    list of Job
    """
    if folder is None:
        (scene,) = scenes
        return [Job(scene, Path(output or f"{scene.material.name}.h5"))]
    return [Job(scene, folder / f"{scene.material.name}.h5", of_study=True) for scene in scenes]


def sort_out(planned, overwrite, note):
    """Leave out the jobs whose files hold what is asked for; make sure that the files of the others can be written.

    Parameters
    ----------
    planned : list of Job
    overwrite : bool
        Whether to replace results, whatever they hold.
    note : callable
        Called with a line on each file that is damaged, and one on those that stay.

    Returns
    -------
    todo : list of Job
    missed : list of str
        A line for each file that stays although its target was not reached, since nothing more is asked for.

    Raises
    ------
    OutputError
        There is no folder for the files, or something stands in the way: all files at once, with what each of them
        differs in.
    """
    from goniosim.report.simulation.target import shortfall
    from goniosim.store import refuse_newer, reserve_output

    make_folder(planned[0].path.parent)
    places = [Path(os.path.realpath(job.path)) for job in planned]
    parts.remove_dead(places)
    claims.remove_dead(places)
    found = {} if overwrite else _look_at(planned)
    for standing in found.values():
        if standing.damage:
            note(f"to be replaced: {standing.damage}")
    kept = {job.path: found[job.path] for job in planned if job.is_finished(found.get(job.path))}
    todo = [job for job in planned if job.path not in kept]
    for job in todo:
        refuse_newer(job.path)
        # Room is kept only for the material at work: a killed study leaves a single hidden file behind.
        reserve_output(job.path, 0).release()
    if kept:
        note(_kept(kept, len(planned)))
    # By whoever asks for rays, the target of a file is not missed.
    missed = [
        f"{job.path}: {shortfall(kept[job.path].simulation)}"
        for job in planned
        if job.path in kept and job.scene.simulation.target is not None and kept[job.path].target_reached is False
    ]
    return todo, missed


def _look_at(planned):
    """What stands in the places of the files, as a dict by path."""
    from goniosim.store import look_at

    found, foreign = {}, []
    for job in planned:
        try:
            standing = look_at(job.path, job.scene)
        except OutputError as error:
            foreign.append(error)
        else:
            if standing is not None:
                found[job.path] = standing
    others = {path: standing.differences for path, standing in found.items() if standing.differences}
    if len(foreign) == 1 and not others:
        raise foreign[0]
    details = [*map(str, foreign), *(f"{path}: {line}" for path, lines in others.items() for line in lines)]
    if len(others) == 1 and not foreign:
        (path,) = others
        raise OutputError(f"{path}: holds the result of another scene; {_REMEDY}", details)
    if details:
        remedy = f"{_REMEDY}, which leaves other files alone" if foreign else _REMEDY
        raise OutputError(f"{len(others) + len(foreign)} files hold something else; {remedy}", details)
    return found


def _kept(kept, planned):
    import numpy as np

    from goniosim.report.text import counts

    held = counts(np.concatenate([standing.rays for standing in kept.values()]))
    if planned == 1:
        ((path, standing),) = kept.items()
        words = " (partial)" if standing.status == "partial" else ""
        target = standing.simulation.target
        accuracy = f", by a target of {target}" if target is not None else ""
        return f"{path} stays as it is{words}: it holds {held} rays per direction of this scene{accuracy}"
    partial = sum(standing.status == "partial" for standing in kept.values())
    what = f"have enough rays, though {partial} of them partial" if partial else "are finished"
    return f"{len(kept)} of {planned} materials {what}: skipped (their files hold {held} rays per direction)"


def require_room(planned):
    """Make sure that the results could be written, and leave nothing behind.

    Parameters
    ----------
    planned : list of Job

    Raises
    ------
    OutputError
        Also if results of other scenes stand there.
    """
    from goniosim.report.simulation.forecast import file_size
    from goniosim.store import reserve_output

    paths = [job.path for job in planned]
    folder = paths[0].parent
    if folder.exists():
        _look_at(planned)
    else:
        # It will be made: then the room is where it will stand.
        standing = next(parent for parent in folder.absolute().parents if parent.exists())
        paths = [standing / path.name for path in paths[:1]]
    for path in paths[1:]:
        reserve_output(path, 0).release()
    reserve_output(paths[0], sum(file_size(job.scene) for job in planned)).release()


def run(jobs, progress, signals, overwrite, every, verbose):
    """Simulate and write, yielding each (job, result) once its file stands; end early when stopped.

    Materials of a study that other processes are at work on, or have finished since, are left to them with a word.

    Parameters
    ----------
    jobs : list of Job
    progress : goniosim.report.progress
    signals : goniosim_cli.signals.StopSignals
    overwrite : bool
    every : float
        Seconds between two checkpoints.
    verbose : bool

    Raises
    ------
    OutputError
        Also if another process is at work on the file of a single scene.
    """
    from goniosim.report.simulation.losses import event_cap

    sharing = Sharing(jobs, lambda job: job.path, partial(_is_done, overwrite))
    for number, job, signals.claim in sharing:
        with signals.claim:
            if signals.reason is not None:
                return
            progress.pass_over(rays_of_others(sharing))
            label = f"{number}/{len(jobs)} {job.name}" if len(jobs) > 1 else job.name
            # What others left of it since is no result to be replaced.
            anew = overwrite and sharing.is_untouched(job)
            result = _done(job, label, progress, signals, verbose, overwrite, anew, every)
        if result is None:
            continue
        if result.status == "partial":
            progress.note(_stopped(job, result, signals))
        if warning := event_cap(result):
            progress.note(f"{label}: {warning}")
        yield job, result
        # Not to be held while the next material is at work.
        del result
    leave_to_others(sharing, progress.note)


def _is_done(overwrite, job, untouched):
    """Whether others have finished a material, which is looked at once nobody else works on it."""
    from goniosim.store import look_at

    if not overwrite:
        return job.is_finished(_look_at([job]).get(job.path))
    return not untouched and job.is_finished(look_at(job.path, job.scene))


def _done(job, label, progress, signals, verbose, overwrite, anew, every):
    """Simulate and write one material; None if it was stopped too early, or its file is worth more."""
    from goniosim._jit.folder import notices
    from goniosim.report.simulation.forecast import effects_text
    from goniosim.report.text import duration
    from goniosim.store import write_result

    if verbose:
        progress.note(effects_text(job.scene))
    signals.gathering = False
    with job.reserve() as signals.reservation:
        seconds = prepare_kernels(job.scene, progress)
        if verbose:
            progress.note(f"{label}: kernels ready after {duration(seconds)}")
            for notice in notices:
                progress.note(notice)
        try:
            result = _simulate(job, label, progress, signals, overwrite, anew, every)
        except StoppedError:
            progress.note(f"stopped by {signals.reason} before the first rays")
            return None
        try:
            write_result(result, job.path, overwrite=overwrite, reservation=signals.reservation)
        except FewerRaysError as error:
            progress.note(f"stopped by {signals.reason}: {error.fact}" if signals.reason else error.fact)
            return None
    return result


def _stopped(job, result, signals):
    from goniosim.report.text import counts

    total = job.scene.total_rays
    held = f"{counts(result.rays)} rays per direction"
    if total is not None:
        held = f"{100.0 * result.rays.sum() / total:.3g} % of the rays"
    further = "; the same command goes on" if result.state is not None else ""
    return f"stopped by {signals.reason}: {job.path} holds {held} (partial){further}"


def _simulate(job, label, progress, signals, overwrite, anew, every):
    from goniosim.engine import simulate
    from goniosim.report.simulation.target import far
    from goniosim.store import keeper

    left = {} if anew else _left(job, progress)
    goes_on = bool(left)

    def report(done_rays, total_rays):
        if not signals.gathering:
            progress.begin(label, inherited=done_rays if goes_on else 0)
            signals.gathering = True
        progress.update(done_rays, total_rays)

    keep = keeper(job.path, overwrite, lambda error: progress.note(f"{label}: no checkpoint: {error}"))
    left["note"] = lambda line: progress.note(f"{job.path}: {line}")
    left["tell"] = lambda outlook: progress.note(f"{label}: {far(job.scene.simulation, outlook)}")
    return simulate(job.scene, progress=report, stop=signals.event, checkpoint=keep, every=every, **left)


def _left(job, progress):
    """What a run goes on from, as `goniosim.engine.simulate` takes it, with a word on it; empty if there is nothing."""
    from goniosim.engine import checked_state, prior_of
    from goniosim.report.text import counts
    from goniosim.store import result_left, state_left

    found, rays = {}, None
    try:
        if left := state_left(job.path, job.scene):
            state, rays = left
            checked_state(state)
            found = {"resume": state}
        elif result := result_left(job.path, job.scene):
            found, rays = {"prior": prior_of(job.scene, result)}, result.rays
    except UnusableResultError as error:
        progress.note(f"{job.path}: begins anew: {error}")
    except GoniosimError:
        # Whatever it is, `sort_out` has spoken of it.
        pass
    if found:
        progress.note(f"{job.path}: goes on from {counts(rays)} rays per direction")
    return found


def prepare_kernels(scene, progress):
    """Compile or load the kernels, saying so when it takes long; return the seconds.

    The compiler cannot be interrupted, so it runs in a thread of its own while
    this one stays ready to be.
    """
    from goniosim.engine import warm_up

    outcome = {}

    def compile_kernels():
        try:
            outcome["seconds"] = warm_up(scene)
        except BaseException as error:
            outcome["error"] = error

    thread = threading.Thread(target=compile_kernels, daemon=True)
    try:
        thread.start()
    except RuntimeError:
        # The system grants no further thread.
        compile_kernels()
    else:
        thread.join(PATIENCE)
        if thread.is_alive():
            progress.note("preparing the kernels: compiled in the first run, taken from the cache later")
            thread.join()
    if "error" in outcome:
        raise outcome["error"]
    return outcome["seconds"]
