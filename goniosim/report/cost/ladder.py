"""A ladder of short runs: each with several times the rays of the one before, the estimators in turns."""

import time
from dataclasses import replace

from ...engine import warm_up
from .runs import ESTIMATORS, asked, run

# What is not analog makes replicates, which take some rays to be worth making.
FIRST = {"auto": 1 << 17, "analog": 1 << 14}
# A rung that takes so many times the rays; a smaller step where the time does not last for that.
STEPS = (4, 2)
# Of these the first tells what the second costs.
FEWEST = 3
# What a direction takes at least, to compile kernels before the clock starts.
_WARM_UP = 1 << 10


def climb(scene, seconds, say, estimators=ESTIMATORS):
    """Run a scene with more and more rays.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    seconds : float
        For each estimator; a few first rungs are run whatever they take.
    say : callable
        Called with a line on what is being done.
    estimators : sequence of str

    Returns
    -------
    dict of str to list of Run
        By estimator, from few rays to many. Only the last keeps its result.
    """
    say("compiling")
    for estimator in estimators:
        run(scene, estimator, _WARM_UP)
    rungs = {estimator: [] for estimator in estimators}
    spent = dict.fromkeys(estimators, 0.0)
    last = dict.fromkeys(estimators, 0.0)
    rays = {estimator: FIRST[estimator] for estimator in estimators}
    while rays:
        # In turns: whatever else the machine does falls on all alike.
        for estimator in list(rays):
            say(f"{estimator}: {rays[estimator]} rays per direction")
            # More rays may call for other means, which are compiled before the clock starts.
            warm_up(asked(scene, estimator, rays[estimator]))
            started = time.perf_counter()
            # A seed of its own for each rung: their errors are independent.
            made = run(scene, estimator, rays[estimator], seed=len(rungs[estimator]) + 1)
            if rungs[estimator]:
                rungs[estimator][-1] = replace(rungs[estimator][-1], result=None)
            rungs[estimator].append(made)
            last[estimator] = time.perf_counter() - started
            spent[estimator] += last[estimator]
            step = _step(len(alike(rungs[estimator])), last[estimator], seconds - spent[estimator])
            if step is None:
                del rays[estimator]
            else:
                rays[estimator] *= step
    return rungs


def alike(rungs, component=None):
    """The runs by the same means as the last one, of which alone a law can be made.

    Parameters
    ----------
    rungs : list of Run
    component : str, optional
        The means for that component; those for all of them by default.

    Returns
    -------
    list of Run
    """

    def means(rung):
        return rung.estimators if component is None else rung.estimators.get(component)

    return [rung for rung in rungs if means(rung) == means(rungs[-1])]


def _step(done, last, left):
    """How many times the rays the next rung has; None if there is none."""
    for step in STEPS:
        if step * last <= left:
            return step
    return STEPS[0] if done < FEWEST else None
