"""The driver: estimators chosen, their runs done, results assembled."""

import contextlib
import threading
from functools import partial

from ..cores import granted_threads
from ..errors import ResourceError, StoppedError, UnusableResultError
from ..scene import with_arguments
from .blas import one_thread
from .checkpoints import Checkpoints
from .drive import Drive
from .extended import OtherEstimatorError
from .memory import memory_needed, require_memory, threads_of
from .outcome import has_room, integrate_direct, progress_of, result_of
from .packing import pack, unpack
from .plan import make_plan
from .probe import warm_up
from .session import VERSION, Session


def simulate(
    scene,
    *,
    progress=None,
    stop=None,
    checkpoint=None,
    every=60.0,
    resume=None,
    prior=None,
    note=lambda line: None,
    tell=None,
    **given,
):
    """Shoot rays at a scene and return its slices with their error bars.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    progress : callable, optional
        Called as ``progress(done_rays, total_rays)`` a few times a second, from this thread;
        ``total_rays`` is that of the scene, None where a target decides.
    stop : threading.Event, optional
        When set, tracing ends within a second; the result holds the finished work units and
        has the status ``partial``. Ctrl-C itself is left to the caller.
    checkpoint : callable, optional
        Called with a partial `Result` from time to time, from this thread, while others go on.
    every : float
        Seconds between two such calls, at least; more where they would take more than a hundredth of the time.
    resume : bytes-like, optional
        ``state`` of a partial result of the same scene and simulation, to go on from. What comes out then is the same
        to the last bit as without the interruption, times aside.
    prior : goniosim.engine.prior.Prior, optional
        What is there already, of other random numbers: only what is missing is traced, and the result is of both. If
        ``resume`` is of such a run, it knows its own.
    note : callable
        Called with a line if it cannot go on from ``prior``, and begins anew.
    tell : callable, optional
        Called with an `goniosim.engine.outlook.Outlook` where a target will take long, or longer than its limits.
    **given
        In the place of what the scene says: ``rays``, ``seed``, ``threads`` and the others of
        `goniosim.scene.with_arguments`. The result does not depend on ``threads``; the default
        is every core this process may use.

    Returns
    -------
    goniosim.result.Result

    Raises
    ------
    goniosim.errors.ConfigError
        If an argument is out of range, or the engine cannot do what is asked.
    goniosim.errors.ResourceError
        If it does not fit into the memory that is free.
    goniosim.errors.StoppedError
        If it was stopped before any work unit was finished, or before an interrupted run went on.
    goniosim.errors.UnusableResultError
        If ``resume`` is not such a state.
    """
    scene = with_arguments(scene, given)
    require_memory(scene, 0 if prior is None else prior.size)
    with guarded():
        before = None if resume is None else checked_state(resume)
        begin = partial(_simulate, scene, progress, stop or threading.Event(), checkpoint, every, tell, before)
        try:
            return begin(prior)
        except OtherEstimatorError as error:
            note(f"begins anew: {error}")
            return begin(None)


@contextlib.contextmanager
def guarded():
    """Around a whole simulation: the library of linear algebra on one thread, and a word where memory runs out."""
    try:
        # Not around single products: the library's own threads spin for a while after each.
        with one_thread():
            yield
    except MemoryError as error:
        raise ResourceError(
            "memory ran out: another process took it, or a limit is lower than it looks; "
            "use fewer threads, coarser slices or fewer incident directions per file"
        ) from error


def checked_state(state):
    """What a packed state says.

    Parameters
    ----------
    state : bytes-like

    Returns
    -------
    dict

    Raises
    ------
    goniosim.errors.UnusableResultError
        If it is no state, or one of another version of goniosim, which would not lead to the same bits.
    """
    try:
        found = unpack(state)
    except ValueError as error:
        raise UnusableResultError(str(error)) from error
    if not isinstance(found, dict) or found.get("version") != VERSION:
        raise UnusableResultError("the interrupted run was of another version of goniosim")
    return found


def _simulate(scene, progress, stop, checkpoint, every, tell, before, prior):
    plan, threads = make_plan(scene), granted_threads(threads_of(scene))
    warm_up(scene)
    direct = integrate_direct(plan, threads, stop)

    needed = memory_needed(scene)

    def besides(session):
        # In the state and in the file of it.
        return 0 if session.prior is None else 2 * session.prior.size

    def keep(session):
        if not has_room(needed.checkpoint + besides(session)):
            return
        looked_at = Session(plan, scene.simulation, Drive(1, threading.Event(), lambda done, total: None))
        looked_at.prior = session.prior
        looked_at.look_at(session.state())
        if looked_at.traced:
            checkpoint(result_of(scene, plan, threads, direct, looked_at, pack(session.state())))

    keeping = None if checkpoint is None else Checkpoints(every, keep)
    drive = Drive(threads, stop, progress_of(scene, progress))
    session = Session(plan, scene.simulation, drive, keeping, before, prior)
    session.tell = tell
    session.has_room = lambda: has_room(needed.state + needed.result + needed.file + besides(session))
    session.run()
    if not session.traced and not (session.prior and session.finished):
        raise StoppedError("stopped before the first rays were through: there is nothing to keep")
    return result_of(scene, plan, threads, direct, session, session.left)
