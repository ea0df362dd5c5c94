"""From runs to a result: components with their error bars, and what they cost."""

import numpy as np

from ..accuracy import norm, relative_error
from ..result import Cost
from . import estimate


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
    found = {"reflection/direct": estimate.assemble(plan, ((*pair, None) for pair in direct), bool(plan.mirrors[0]))}
    run_of = {side: run for run in runs for side in run.sides}
    for side in sorted(run_of):
        name, delta = estimate.COMPONENT_OF[side], plan.has_specular_chain(side)
        found[name] = _component(plan, run_of[side], side, None, delta)
        count, lowest = int(plan.slots[side, 1]), int(plan.slots[side, 2])
        for order in range(count) if plan.orders else ():
            label = f"order_{lowest + order}" + ("_and_more" if order == count - 1 else "")
            found[name].orders[label] = _component(plan, run_of[side], side, order, delta)
    return found


def _component(plan, run, side, order, delta):
    directions = range(len(plan.theta_deg))

    def slices():
        for m in directions:
            energy, stderr, _, hits = run.slices(side, m, order)
            yield energy, stderr, hits

    return estimate.assemble(plan, slices(), delta)


def cost(plan, runs, seconds):
    """What accuracy cost, for each direction at its checkpoints.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    runs : list of AnalogRun or ReplicatedRun
        With different ways out.
    seconds : float
        Wall-clock time of all of them.

    Returns
    -------
    goniosim.result.Cost
        Its seconds are the processor's, in proportion to the wall-clock time of the whole.
    """
    directions = len(plan.theta_deg)
    most = max(len(noted) for run in runs for noted in run.spending.checkpoints)
    shape = (directions, most)
    rays, cpu_seconds = np.zeros(shape), np.zeros(shape)
    error = {}
    for run in runs:
        for m, noted in enumerate(run.spending.checkpoints):
            # A direction that was through earlier stays as it was.
            rows = noted + noted[-1:] * (most - len(noted))
            rays[m] = np.maximum(rays[m], [row[0] for row in rows])
            cpu_seconds[m] += [row[1] for row in rows]
            for name in rows[0][2]:
                error.setdefault(name, np.zeros(shape))[m] = [row[2][name] for row in rows]
    total = cpu_seconds[:, -1].sum()
    return Cost(rays, cpu_seconds * (seconds / total if total > 0.0 else 0.0), cpu_seconds, error)


def errors(plan, run, direction):
    """Noise of the components of a run in one direction, as `goniosim.result.Cost.error`."""
    size, weights = valid_size(plan, direction), estimate.channel_weights(plan)
    return {
        estimate.COMPONENT_OF[side]: float(norm(run.slices(side, direction)[1], size) @ weights) for side in run.sides
    }


def worst_error(plan, run, direction, of):
    """Largest relative error of the components of a run in one direction, see `goniosim.accuracy.relative_error`.

    What nodes let the energies be off counts as an error too.
    """
    size, weights = valid_size(plan, direction), estimate.channel_weights(plan)
    found = []
    for side in run.sides:
        energy, stderr = run.slices(side, direction)[:2]
        value, error = run.total(side, direction)
        if direction in run.bias:
            stderr = np.hypot(stderr, run.bias[direction])
            error = np.hypot(error, run.bias[direction].sum(axis=(1, 2)))
        found.append(relative_error(of, energy, stderr, (value, error), size, weights))
    return max(found)


def valid_size(plan, direction):
    """Projected solid angles of the cells in sr, 0 for those that are not valid; ndarray, shape (rows, columns)."""
    geometry = plan.geometry[direction]
    return np.where(geometry.valid, geometry.projected_solid_angle, 0.0)
