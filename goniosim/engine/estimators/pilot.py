"""Whether independent paths reach an accuracy before others have begun.

A pilot of the analog walk, on a key of its own, tells how many rays an accuracy takes. Work is counted in
events, never by a clock: so the choice is the same on every machine and any number of threads.
"""

import numpy as np

from .. import assembly
from ..analog import AnalogRun
from ..unit import child_key

# Child of the seed's key, beside the work units', the pilot's of the roulette and the replicates'.
BRANCH = 3
RAYS = 1 << 15
# What the first round of an estimator costs in each direction, in events of the analog walk: measured, rounded.
FIRST_ROUND = {"connection": 5e6, "operator": 2e7, "split": 4e6}


def analog_rays(plan, seed, target, drive):
    """Rays of each direction that the analog walk needs, as far as a pilot can tell.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    seed : int
    target : goniosim.scene target
    drive : goniosim.engine.drive.Drive

    Returns
    -------
    rays, events : ndarray, shape (M,)
        And the events of them. Infinite where the pilot saw nothing, which says nothing.
    """
    sides = tuple(side for side in (0, 1) if plan.slots[side, 1] > 0)
    run = AnalogRun(plan, child_key(seed, BRANCH), sides)
    run.prepare()
    for works in run.rounds(RAYS):
        drive.do(run, works)
    directions = range(len(plan.theta_deg))
    errors = np.array([assembly.worst_error(plan, run, m, target.of) for m in directions])
    rays = RAYS * np.maximum(errors / target.relative_error, 1.0) ** 2
    return rays, rays * run.spending.events / RAYS


def is_enough(choices, events):
    """Whether so many events are fewer than those of the first rounds of the estimators chosen.

    Parameters
    ----------
    choices : list of goniosim.engine.estimators.choose.Choice
    events : ndarray, shape (M,)
        Of the analog walk.
    """
    return bool(events.mean() < sum(FIRST_ROUND[choice.estimator] for choice in choices))
