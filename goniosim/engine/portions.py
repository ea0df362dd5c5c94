"""Simulations in portions: each traced for itself, on any machine, and joined to what one run would have yielded."""

import threading
from dataclasses import dataclass

from ..cores import granted_threads
from ..errors import StoppedError, UnusableResultError
from .checkpoints import Checkpoints
from .drive import Drive
from .joining import Joint
from .memory import memory_needed, require_memory, threads_of
from .outcome import has_room, integrate_direct, result_of
from .packing import pack
from .pieces import start
from .plan import make_plan
from .portion import Portion
from .probe import warm_up
from .session import Session
from .simulate import checked_state, guarded


@dataclass(frozen=True)
class Traced:
    """A portion, as far as it is traced.

    Attributes
    ----------
    state : bytes
        For `join_portions`, and to go on from.
    done_rays, total_rays : int
        Light paths that it holds, and that belong to it; equal if it is whole, and only then.
    noise : float or None
        See `portion.Portion.noise`.
    """

    state: bytes
    done_rays: int
    total_rays: int
    noise: float | None


# What reading a state of somebody else's making may raise.
_MISFIT = (ValueError, TypeError, LookupError, AttributeError, ArithmeticError)


def trace_portion(scene, first, end, *, progress=None, stop=None, checkpoint=None, every=60.0, resume=None):
    """Trace some of the pieces of a scene.

    Parameters
    ----------
    scene : goniosim.scene.Scene
        Without a target.
    first, end : int
        From the ``first`` piece of `pieces.piece_rays` to the one before ``end``.
    progress : callable, optional
        Called as ``progress(done_rays, total_rays)`` a few times a second, of the light paths of the portion.
    stop : threading.Event, optional
        When set, tracing ends within a second.
    checkpoint : callable, optional
        Called with a `Traced` from time to time.
    every : float
        Seconds between two such calls, at least.
    resume : bytes-like, optional
        A state of the same portion, to go on from.

    Returns
    -------
    Traced

    Raises
    ------
    goniosim.errors.ResourceError
        If it does not fit into the memory that is free.
    goniosim.errors.StoppedError
        If it was stopped before any work was through.
    goniosim.errors.UnusableResultError
        If ``resume`` is not such a state.
    """
    require_memory(scene)
    with guarded():
        plan, threads = make_plan(scene), granted_threads(threads_of(scene))
        warm_up(scene)
        portion = Portion(plan, scene.simulation, first, end)
        if resume is not None:
            _fitted(portion.restore, checked_state(resume))
        room = memory_needed(scene).checkpoint

        def kept(portion):
            if has_room(room):
                checkpoint(_traced(portion))

        keep = None if checkpoint is None else Checkpoints(every, kept)
        portion.run(Drive(threads, stop or threading.Event(), progress or (lambda done, total: None)), keep)
        if not portion.done:
            raise StoppedError("stopped before the first rays were through: there is nothing to keep")
        return _traced(portion)


def _traced(portion):
    return Traced(pack(portion.state()), portion.rays, portion.total_rays, portion.noise)


def join_portions(scene, states, *, stop=None):
    """The result of portions.

    Parameters
    ----------
    scene : goniosim.scene.Scene
        Without a target.
    states : iterable of bytes-like
        In the order of their pieces.
    stop : threading.Event, optional
        When set, this ends within a second.

    Returns
    -------
    goniosim.result.Result
        The same to the last bit, times aside, as if one run had traced all pieces; ``partial`` if some are missing.
        Its times are those of all portions together.

    Raises
    ------
    goniosim.errors.ResourceError
        If it does not fit into the memory that is free.
    goniosim.errors.StoppedError
        If it was stopped.
    goniosim.errors.UnusableResultError
        If a state is not one of this scene, or holds what another one holds; its number is in ``number``.
    """
    require_memory(scene)
    stop = stop or threading.Event()
    with guarded():
        plan, threads = make_plan(scene), granted_threads(threads_of(scene))
        warm_up(scene)
        direct = integrate_direct(plan, threads, stop)
        session = Session(plan, scene.simulation, Drive(threads, stop, lambda done, total: None))
        session.choices, session.runs = start(plan, scene.simulation)
        joint = Joint(plan, session.runs, scene.simulation.rays)
        for number, state in enumerate(states):
            try:
                _fitted(joint.add, checked_state(state))
            except UnusableResultError as error:
                error.number = number
                raise
        joint.finish()
        session.look_where_energy_goes()
        return result_of(scene, plan, threads, direct, session)


def _fitted(take, state):
    try:
        take(state)
    except _MISFIT as error:
        raise UnusableResultError(f"it does not fit the scene: {error}") from error
