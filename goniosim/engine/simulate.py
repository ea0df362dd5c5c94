"""The driver: estimators chosen, their runs done, results assembled."""

import threading

import numpy as np

from ..cores import granted_threads
from ..errors import ResourceError, StoppedError, UnusableResultError
from ..free_memory import free_memory
from ..integration import Pool
from ..provenance import provenance
from ..result import Result
from ..scene import CHANNELS, effects, with_arguments
from . import assembly, estimate
from .blas import one_thread
from .checkpoints import Checkpoints
from .direct import direct_reflection
from .drive import Drive
from .memory import memory_needed, require_memory, threads_of
from .packing import pack, unpack
from .plan import make_plan
from .probe import warm_up
from .session import VERSION, Session


def simulate(scene, *, progress=None, stop=None, checkpoint=None, every=60.0, resume=None, **given):
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
    require_memory(scene)
    try:
        # Not around single products: the library's own threads spin for a while after each.
        with one_thread():
            return _simulate(scene, progress, stop or threading.Event(), checkpoint, every, resume)
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


def _simulate(scene, progress, stop, checkpoint, every, resume):
    before = None if resume is None else checked_state(resume)
    plan, threads = make_plan(scene), granted_threads(threads_of(scene))
    warm_up(scene)
    direct = _integrate_direct(plan, threads, stop)

    needed = memory_needed(scene)

    def has_room(n_bytes):
        # Rather no checkpoint than the end of the run.
        free = free_memory()
        return free is None or free[0] >= n_bytes

    def keep(session):
        if not has_room(needed.checkpoint):
            return
        looked_at = Session(plan, scene.simulation, Drive(1, threading.Event(), lambda done, total: None))
        looked_at.look_at(session.state())
        if any(looked_at.rays):
            checkpoint(_result(scene, plan, threads, direct, looked_at, pack(session.state())))

    keeping = None if checkpoint is None else Checkpoints(every, keep)
    session = Session(plan, scene.simulation, Drive(threads, stop, _progress_of(scene, progress)), keeping, before)
    session.has_room = lambda: has_room(needed.state + needed.result + needed.file)
    session.run()
    if not any(session.rays):
        raise StoppedError("stopped before the first rays were through: there is nothing to keep")
    return _result(scene, plan, threads, direct, session, session.left)


def _result(scene, plan, threads, direct, session, state):
    found = assembly.components(plan, session.runs, direct)
    return Result(
        config_yaml=scene.to_yaml(),
        config_hash=scene.config_hash(),
        name=scene.material.name,
        status="complete" if session.finished else "partial",
        seed=scene.simulation.seed,
        theta_deg=plan.theta_deg,
        phi_deg=np.zeros_like(plan.theta_deg),
        rays=np.array(session.rays, dtype=np.int64),
        channels=list(CHANNELS),
        cells=estimate.cells(plan),
        components=found,
        audit=estimate.audit(plan, session.audit.ledgers, session.audit.part_rays, found["reflection/direct"]),
        cost=assembly.cost(plan, session.runs),
        effects={effect.name: effect.active for effect in effects(scene)},
        provenance={**provenance(threads), **session.provenance},
        target_reached=session.reached,
        state=None if session.finished else state,
    )


def _progress_of(scene, progress):
    """Light paths of all runs, told in rays of the scene: an audit and further components are work too."""
    if progress is None:
        return lambda done, total: None
    whole = scene.total_rays
    return lambda done, total: progress(done if whole is None else whole * done // max(total, 1), whole)


def _integrate_direct(plan, threads, stop):
    """`direct_reflection` of every direction; before tracing, so that a stop need not wait for it."""
    with Pool(threads) as pool:
        return [direct_reflection(plan, direction, pool, stop) for direction in range(len(plan.theta_deg))]
