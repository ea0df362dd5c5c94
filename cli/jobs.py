"""The materials of one command, one after the other: reserve, compile, simulate, write."""

import threading
from dataclasses import dataclass
from pathlib import Path

from goniosim.errors import DamagedFileError, ForeignFileError, StoppedError
from goniosim.writing import make_folder

# Kernels from the cache load faster than this; a longer wait deserves a word.
PATIENCE = 1.0


@dataclass(frozen=True)
class Job:
    """A scene and the file its result goes to."""

    scene: object
    path: Path

    @property
    def name(self):
        """Name of the material."""
        return self.scene.material.name

    @property
    def rays(self):
        """Rays of all incident directions together."""
        return len(self.scene.incident.theta_deg) * self.scene.simulation.rays

    def is_finished(self):
        """Whether the file already holds the complete result of just this scene."""
        from goniosim.store import read_header

        try:
            header = read_header(self.path)
        except (ForeignFileError, DamagedFileError):
            return False
        return header["status"] == "complete" and header["config_hash"] == self.scene.config_hash()

    def reserve(self):
        """Make sure that the file can be written, and keep room for it."""
        from goniosim.report.simulation.forecast import file_size
        from goniosim.store import reserve_output

        return reserve_output(self.path, file_size(self.scene))


def plan(scenes, output, folder):
    """Pair the scenes with their files, and make sure now that nothing stands in the way of these.

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

    Raises
    ------
    OutputError
    """
    from goniosim.store import reserve_output

    if folder is None:
        (scene,) = scenes
        planned = [Job(scene, Path(output or f"{scene.material.name}.h5"))]
    else:
        planned = [Job(scene, folder / f"{scene.material.name}.h5") for scene in scenes]
    make_folder(planned[0].path.parent)
    for job in planned:
        # Room is kept only for the material at work: a killed study leaves a single hidden file behind.
        reserve_output(job.path, 0).release()
    return planned


def run(jobs, progress, signals, verbose):
    """Simulate and write, yielding each (job, result) once its file stands; end early when stopped."""
    from goniosim._jit.folder import notices
    from goniosim.report.simulation.forecast import effects_text
    from goniosim.report.simulation.losses import event_cap
    from goniosim.report.text import duration
    from goniosim.store import write_result

    for number, job in enumerate(jobs, 1):
        if signals.signum is not None:
            return
        label = f"{number}/{len(jobs)} {job.name}" if len(jobs) > 1 else job.name
        if verbose:
            progress.note(effects_text(job.scene))
        signals.gathering = False
        with job.reserve() as signals.reservation:
            seconds = _warm_up(job.scene, progress)
            if verbose:
                progress.note(f"{label}: kernels ready after {duration(seconds)}")
                for notice in notices:
                    progress.note(notice)
            try:
                result = _simulate(job.scene, label, progress, signals)
            except StoppedError:
                progress.note(f"stopped by {signals.name} before the first rays")
                return
            write_result(result, job.path, reservation=signals.reservation)
        if result.status == "partial":
            percent = 100.0 * result.rays.sum() / job.rays
            progress.note(f"stopped by {signals.name}: {job.path} holds {percent:.3g} % of the rays (partial)")
        if warning := event_cap(result):
            progress.note(f"{label}: {warning}")
        yield job, result


def _simulate(scene, label, progress, signals):
    from goniosim.engine import simulate

    def report(done_rays, total_rays):
        if not signals.gathering:
            progress.begin(label)
            signals.gathering = True
        progress.update(done_rays, total_rays)

    return simulate(scene, progress=report, stop=signals.event)


def _warm_up(scene, progress):
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
