"""From a session to a result, and what stands around one: progress, memory, the direct reflection."""

import numpy as np

from ..free_memory import free_memory
from ..integration import Pool
from ..provenance import provenance
from ..result import Result
from ..scene import CHANNELS, effects
from . import assembly, estimate
from .combining import combined_audits
from .direct import direct_reflection


def result_of(scene, plan, threads, direct, session, state=None):
    """The result of a session.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    plan : goniosim.engine.plan.Plan
    threads : int
    direct : list of (ndarray, ndarray)
        As of `integrate_direct`.
    session : goniosim.engine.session.Session
    state : bytes, optional
        What it goes on from, if it is not finished.

    Returns
    -------
    goniosim.result.Result
    """
    found, prior = assembly.components(plan, session.known, direct), session.prior
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
        audit=_balance(plan, session, found["reflection/direct"]),
        cost=assembly.cost(plan, session.known, prior and prior.cost),
        effects={effect.name: effect.active for effect in effects(scene)},
        provenance={**provenance(threads), **session.provenance},
        target_reached=session.reached,
        state=None if session.finished else state,
    )


def _balance(plan, session, direct):
    before, run = session.prior and session.prior.audit, session.audit
    if run is None:
        return before
    found = estimate.audit(plan, run.ledgers, run.part_rays, direct)
    return combined_audits(before, found) if before else found


def progress_of(scene, progress):
    """Light paths of all runs, told in rays of the scene: an audit and further components are work too."""
    if progress is None:
        return lambda done, total: None
    whole = scene.total_rays
    return lambda done, total: progress(done if whole is None else whole * done // max(total, 1), whole)


def integrate_direct(plan, threads, stop):
    """`direct_reflection` of every direction; before tracing, so that a stop need not wait for it."""
    with Pool(threads) as pool:
        return [direct_reflection(plan, direction, pool, stop) for direction in range(len(plan.theta_deg))]


def has_room(n_bytes):
    """Whether there is memory for what can be left out, so that it is not the end of a run."""
    free = free_memory()
    return free is None or free[0] >= n_bytes
