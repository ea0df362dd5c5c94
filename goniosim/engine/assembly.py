"""From runs to a result: components with their error bars, and what they cost."""

import math

import numpy as np

from ..accuracy import FAINTEST, bound
from ..result import INTEGRATED, Cost
from .estimate import COMPONENT_OF, Estimate, assemble, channel_weights, noise, shared_seconds, valid_size
from .reach import most_light


def components(plan, runs, direct):
    """All components of the result.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    runs : list of AnalogRun or ReplicatedRun
        With different ways out.
    direct : list of (ndarray, ndarray)
        What `direct.direct_reflection` yields for each direction.

    Returns
    -------
    dict of str to goniosim.result.Component
    """
    integrated = (Estimate(energy, stderr, stderr.sum(axis=(1, 2))) for energy, stderr in direct)
    found = {"reflection/direct": assemble(plan, integrated, INTEGRATED, bool(plan.mirrors[0]))}
    run_of = {side: run for run in runs for side in run.sides}
    for side in sorted(run_of):
        name, delta = COMPONENT_OF[side], plan.has_specular_chain(side)
        found[name] = _component(plan, run_of[side], side, None, delta)
        for order, label in enumerate(order_labels(plan)[name]):
            found[name].orders[label] = _component(plan, run_of[side], side, order, delta)
    return found


def order_labels(plan):
    """Names of the orders of each component that is sampled, dict of str to tuple of str."""
    found = {}
    for side, name in COMPONENT_OF.items():
        count, lowest = int(plan.slots[side, 1]), int(plan.slots[side, 2])
        numbers = range(lowest, lowest + count - 1) if plan.orders else ()
        last = (f"order_{lowest + count - 1}_and_more",) if plan.orders else ()
        if count:
            found[name] = (*(f"order_{number}" for number in numbers), *last)
    return found


def _component(plan, run, side, order, delta):
    estimates = (run.estimate(side, m, order) for m in range(len(plan.theta_deg)))
    return assemble(plan, estimates, run.name, delta)


def cost(plan, runs, before=None):
    """What accuracy cost, for each direction at its checkpoints.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    runs : list of AnalogRun or ReplicatedRun or Extended
        With different ways out.
    before : goniosim.result.Cost, optional
        Of what there was before the runs.

    Returns
    -------
    goniosim.result.Cost
    """
    directions = len(plan.theta_deg)
    most = max(len(noted) for run in runs for noted in run.spending.checkpoints)
    shape = (directions, most)
    rays, cpu_seconds, elapsed, error = np.zeros(shape), np.zeros(shape), np.zeros(most), {}
    for run in runs:
        # A direction that was through earlier, or never begun, stays as it was.
        names = [COMPONENT_OF[side] for side in run.sides]
        for name in names:
            error[name] = np.zeros(shape) if before is None else np.tile(before.error[name][:, -1:], most)
        nothing = (0, 0.0, 0.0, None)
        kept = [noted + (noted or [nothing])[-1:] * (most - len(noted)) for noted in run.spending.checkpoints]
        for m, rows in enumerate(kept):
            rays[m] = np.maximum(rays[m], [row[0] for row in rows])
            cpu_seconds[m] += [row[1] for row in rows]
            for name in names if run.spending.checkpoints[m] else ():
                error[name][m] = [row[3][name] for row in rows]
        elapsed += np.max([[row[2] for row in rows] for rows in kept], axis=0)
    return after(before, Cost(rays, shared_seconds(elapsed, cpu_seconds), cpu_seconds, error))


def after(before, found):
    """Costs that go on from others, if there are any.

    Parameters
    ----------
    before : goniosim.result.Cost or None
    found : goniosim.result.Cost
        Its errors are those with what was there before.

    Returns
    -------
    goniosim.result.Cost
    """
    if before is None:
        return found

    def summed(name):
        held, added = getattr(before, name), getattr(found, name)
        return np.concatenate([held, held[:, -1:] + added], axis=1)

    error = {name: np.concatenate([before.error[name], added], axis=1) for name, added in found.error.items()}
    return Cost(summed("rays"), summed("seconds"), summed("cpu_seconds"), error)


def errors(plan, run, direction):
    """Noise of the components of a run in one direction, as `goniosim.result.Cost.error`."""
    return {COMPONENT_OF[side]: noise(plan, direction, run.estimate(side, direction).stderr) for side in run.sides}


def worst_error(plan, run, direction, of):
    """What a target is held against in one direction: the largest `goniosim.accuracy.bound` of a run's components.

    Infinite if nothing was seen of one that may receive light; one that is dark for sure has no error.
    """
    size, weights = valid_size(plan, direction), channel_weights(plan)
    found = []
    for side in run.sides:
        one = run.estimate(side, direction)
        total = one.energy.sum(axis=(1, 2)), one.total_stderr
        error = bound(of, one.energy, one.stderr, total, size, weights, one.noise, one.bias)
        is_dark = math.isinf(error) and most_light(plan, side, direction) == 0.0
        found.append(0.0 if is_dark else error)
    # Nothing but the direct reflection may leave.
    return max(found, default=0.0)


def is_too_faint(plan, run, direction):
    """Whether so little light can leave in one direction that no number of light paths tells an error of it."""
    return any(0.0 < most_light(plan, side, direction) < FAINTEST for side in run.sides)


def floor(plan, run, direction):
    """What nodes may be off by in one direction, relative to the slice: the largest of a run's components, or 0."""
    found = [0.0]
    for side in run.sides:
        one = run.estimate(side, direction)
        whole = noise(plan, direction, one.energy)
        if one.bias and whole > 0.0:
            found.append(one.bias / whole)
    return max(found)
