"""A run with what there was before it: as `assembly` takes runs, it tells what both have yielded together."""

import numpy as np

from ..errors import UnusableResultError
from ..scene.quantity import percent
from . import assembly
from .combining import combined
from .estimate import COMPONENT_OF
from .estimators import ESTIMATORS
from .estimators.choose import AUTO, Choice, choose
from .plan import make_plan
from .prior import read_prior

# What nodes may be off by is no more than that share of a target, or the noise would have to be less than half of it.
MOST_OF_TARGET = 0.9


class OtherEstimatorError(UnusableResultError):
    """What is there was made by another estimator than the one that serves what is asked for."""


class Extended:
    """What is known of some ways out.

    Parameters
    ----------
    run : AnalogRun or ReplicatedRun or Past
    prior : goniosim.engine.prior.Prior
    """

    def __init__(self, run, prior):
        self.sides, self.name = run.sides, run.name
        self._run, self._prior = run, prior

    @property
    def spending(self):
        """Of the run alone."""
        return self._run.spending

    @property
    def rays(self):
        """Light paths of each direction, ndarray of int64, shape (M,)."""
        return self._prior.rays(self.sides) + np.array(self._run.rays, np.int64)

    def estimate(self, side, direction, order=None):
        """As `goniosim.engine.analog.AnalogRun.estimate`."""
        before = self._prior.estimate(side, direction, order)
        # There is nothing to tell of a direction that was not begun.
        return combined(before, self._run.estimate(side, direction, order)) if self._run.rays[direction] else before


class Past:
    """One way out of a prior, as a run that is over.

    Parameters
    ----------
    prior : goniosim.engine.prior.Prior
    side : int
    """

    def __init__(self, prior, side):
        self.sides, self.name = (side,), prior.estimators[COMPONENT_OF[side]]
        self.rays = prior.rays(self.sides)
        self.estimate = prior.estimate


def prior_of(scene, result):
    """What a run of a scene goes on from.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    result : goniosim.result.Result
        Of the same scene; it holds less than is asked for.

    Returns
    -------
    goniosim.engine.prior.Prior

    Raises
    ------
    goniosim.errors.UnusableResultError
        If it is of another version of goniosim, does not hold what it takes, or was made by another estimator than the
        one that serves so many rays. Which one serves a target turns out later.
    """
    plan, asked = make_plan(scene), scene.simulation
    prior = read_prior(plan, result)
    if asked.target is None:
        gone_on(plan, choose(plan, asked.estimator, asked.rays), prior, asked)
    return prior


def gone_on(plan, choices, prior, simulation):
    """Choices that go on from what is there.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    choices : list of goniosim.engine.estimators.choose.Choice
        As without it.
    prior : goniosim.engine.prior.Prior
    simulation : goniosim.scene simulation

    Returns
    -------
    list of goniosim.engine.estimators.choose.Choice
        With the next best in the place of one that the nodes of an operator had ruled out before.

    Raises
    ------
    OtherEstimatorError
        If there is no such choice.
    """
    made = []
    for choice in choices:
        names = {prior.estimators[COMPONENT_OF[side]] for side in choice.sides} or {choice.estimator}
        if names != {choice.estimator}:
            choice = _next_best(choice, names, simulation)
        if simulation.target is not None and simulation.estimator == AUTO:
            _require_room(plan, choice, prior, simulation.target)
        made.append(choice)
    return made


def _next_best(choice, names, simulation):
    order = list(ESTIMATORS)
    if simulation.estimator == AUTO and len(names) == 1 and choice.estimator in order:
        (name,) = names
        if name in order[order.index(choice.estimator) :]:
            return Choice(name, choice.sides, "as what is there already")
    held = " and ".join(sorted(names))
    raise OtherEstimatorError(f"what is there was made by {held}, and {choice.estimator} serves what is asked for")


def _require_room(plan, choice, prior, target):
    for side in choice.sides:
        past = Past(prior, side)
        floor = max(assembly.floor(plan, past, m) for m in range(len(plan.theta_deg)))
        if floor >= MOST_OF_TARGET * target.relative_error:
            raise OtherEstimatorError(
                f"nodes of {choice.estimator} may be off by {percent(floor)}, which leaves no room in the target"
            )
