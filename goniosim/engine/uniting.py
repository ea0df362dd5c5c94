"""Two results of the same scene and different seeds, made one."""

import numpy as np

from ..errors import UnusableResultError
from ..provenance import provenance
from ..result import Cost, Result
from ..scene import parse_scene, with_arguments
from ..scene.model import MOST_RAYS, Rays
from . import assembly
from .combining import combined_audits
from .estimate import COMPONENT_OF
from .extended import Extended, Past
from .plan import make_plan
from .prior import read_prior
from .simulate import guarded


def unite(one, other):
    """The result of all light paths of two.

    Parameters
    ----------
    one, other : goniosim.result.Result
        Of the same scene but for the seed, without a seed in common.

    Returns
    -------
    goniosim.result.Result
        Of the scene of the one with the smaller seed, which asks for as many rays as there are. Its cost goes on from
        that of this one: it has a checkpoint more.

    Raises
    ------
    goniosim.errors.UnusableResultError
        If they were made by different estimators, by another version of goniosim, or do not hold what it takes.
    """
    one, other = sorted((one, other), key=lambda result: result.seed)
    with guarded():
        return _united(one, other)


def _united(one, other):
    scene = parse_scene(one.config_yaml)
    plan = make_plan(scene)
    first, second = read_prior(plan, one), read_prior(plan, other)
    if first.estimators != second.estimators:
        name = next(name for name, estimator in first.estimators.items() if estimator != second.estimators[name])
        raise UnusableResultError(
            f"{name} was made by {second.estimators[name]}, and with seed {one.seed} by {first.estimators[name]}: "
            "simulate with the same --estimator"
        )
    sides = [side for side, name in COMPONENT_OF.items() if name in first.estimators]
    runs = [Extended(Past(second, side), first) for side in sides]
    found = assembly.components(plan, runs, _direct(plan, one))
    rays = np.min([run.rays for run in runs], axis=0) if runs else first.rays(()) + second.rays(())
    scene = with_arguments(scene, {"rays": int(np.clip(rays.min(), Rays.low, MOST_RAYS))})
    seeds = sorted({*first.seeds, *second.seeds})
    known = {name: one.provenance[name] for name in ("estimator_choice",) if name in one.provenance}
    whole = all(result.status == "complete" for result in (one, other))
    return Result(
        config_yaml=scene.to_yaml(),
        config_hash=scene.config_hash(),
        name=one.name,
        status="complete" if whole else "partial",
        seed=one.seed,
        theta_deg=one.theta_deg,
        phi_deg=one.phi_deg,
        rays=rays,
        channels=one.channels,
        cells=one.cells,
        components=found,
        audit=combined_audits(second.audit, first.audit),
        cost=_cost(plan, runs, first.cost, second.cost),
        effects=one.effects,
        provenance={**provenance(1), **known, "merged_seeds": ", ".join(map(str, seeds))},
    )


def _direct(plan, result):
    """The integrated direct reflection, as `assembly.components` takes it: that of both."""
    direct = result.components["reflection/direct"]
    pairs = zip(direct.energy, direct.stderr, strict=True)
    return [(energy[plan.distinct], stderr[plan.distinct]) for energy, stderr in pairs]


def _cost(plan, runs, before, added):
    directions = range(len(plan.theta_deg))
    found = [{name: error for run in runs for name, error in assembly.errors(plan, run, m).items()} for m in directions]
    error = {name: np.array([[of[name]] for of in found]) for name in before.error}
    last = {name: getattr(added, name)[:, -1:] for name in ("rays", "seconds", "cpu_seconds")}
    return assembly.after(before, Cost(**last, error=error))
