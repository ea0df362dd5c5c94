"""What an estimator gains over independent paths, told from what there is in any case.

An independent path that carries the weight w into a cell adds w^2 to the second moment of the cell's energy. What
leaves a stack one way carries about the same everywhere, so that the mean of w^2 over that of w, of a few paths without
slices, tells the noise that independent paths would have had on these slices.
"""

import numpy as np

from .estimate import COMPONENT_OF, Estimate, mean_and_error, moments, noise


def noise_of_a_path(plan, direction, energy, short):
    """Noise on a slice of a single independent path.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    direction : int
    energy : ndarray, shape (distinct channels, rows, columns)
        Of the slice.
    short : goniosim.engine.estimate.Estimate
        Of the same way out and direction, by independent paths, in any number of cells.

    Returns
    -------
    float
        In sr^-1/2; that of N paths is smaller by the root of N.
    """
    total = short.energy.sum(axis=(1, 2))
    squares = (short.stderr**2 * short.count + short.energy**2).sum(axis=(1, 2))
    carried = np.divide(squares, total, out=np.zeros_like(total), where=total > 0.0)
    return noise(plan, direction, np.sqrt(np.maximum(energy * carried[:, None, None] - energy**2, 0.0)))


def gains(plan, runs, audit):
    """How many times the processor time of the runs independent paths would take for the same noise.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    runs : list of AnalogRun or ReplicatedRun
    audit : AnalogRun
        A short one.

    Returns
    -------
    dict of str to float
        By component, all directions together; without those of independent paths and those that hold nothing.
    """
    found = {}
    for run in (run for run in runs if not run.audits):
        for side in run.sides:
            theirs = sum(_seconds_of_paths(plan, run, audit, side, m) for m in range(len(plan.theta_deg)))
            if theirs > 0.0:
                found[COMPONENT_OF[side]] = float(theirs / run.spending.cpu_seconds.sum())
    return found


def _seconds_of_paths(plan, run, audit, side, direction):
    error, paths = noise(plan, direction, run.estimate(side, direction).stderr), audit.rays[direction]
    if error == 0.0 or paths == 0:
        return 0.0
    one = noise_of_a_path(plan, direction, run.estimate(side, direction).energy, audit.estimate(side, direction))
    return (one / error) ** 2 * audit.spending.cpu_seconds[direction] / paths


def expected(plan, trials, histogram, paths, seconds_per_path, rays):
    """As `gains`, before a run.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    trials : list of goniosim.engine.trial.Trial
    histogram : ndarray
        Of ``paths`` independent paths, over all directions.
    paths : int
    seconds_per_path : float
        Processor time.
    rays : int
        Light paths of each direction of the run.

    Returns
    -------
    dict of str to float
    """
    middle, found = len(plan.theta_deg) // 2, {}
    for trial in trials:
        for side, slices in trial.slices.items():
            total, squares, _ = moments(histogram, plan, *plan.slots[side, :2])
            mean, stderr = mean_and_error(total, squares, paths)
            one, own = (
                noise_of_a_path(plan, middle, slices, Estimate(mean, stderr, None, paths)),
                trial.noise(side, rays),
            )
            if one > 0.0 and own > 0.0:
                seconds = (one / own) ** 2 * seconds_per_path * len(plan.theta_deg)
                found[COMPONENT_OF[side]] = seconds / (trial.shared + trial.seconds(rays))
    return found


def in_words(found):
    """Gains by component, to two digits."""
    return "; ".join(f"{name}: {gain:.2g}" for name, gain in found.items())
