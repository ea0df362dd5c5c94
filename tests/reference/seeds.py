"""Many simulations of one direction in one go: every run is an incident direction with random numbers of its own."""

import threading
from dataclasses import replace

import numpy as np
from scipy import stats

from goniosim.engine import assembly, estimate
from goniosim.engine.drive import Drive
from goniosim.engine.plan import make_plan
from goniosim.engine.session import Session

from .scenes import make_scene

# Sigmas beyond which a right error is with a probability of 1e-10.
LIMIT = 6.47


def many_runs(layers, theta, estimator, rays, count, seed=1, rows=3, columns=4, parametrization="classic"):
    """Components and audit of ``count`` independent runs, which are the directions of both.

    Returns
    -------
    components : dict of str to goniosim.result.Component
    audit : goniosim.result.Audit
    """
    scene = make_scene(layers, theta, parametrization, rows, columns, rays=rays, estimator=estimator, seed=seed)
    plan = make_plan(scene)
    plan = replace(plan, theta_deg=np.repeat(plan.theta_deg, count), light=np.repeat(plan.light, count, axis=0))
    session = Session(plan, scene.simulation, Drive(1, threading.Event(), lambda done, total: None))
    session.run()
    # What is integrated is not of interest, and would take its time.
    nothing = np.zeros((plan.n_distinct, rows, columns))
    found = assembly.components(plan, session.runs, [(nothing, nothing)] * count)
    audit = estimate.audit(plan, session.audit.ledgers, session.audit.part_rays, found.pop("reflection/direct"))
    return found, audit


def stated_over_true(values, stderr):
    """Stated standard error over the scatter of independent runs, and how right that is.

    Parameters
    ----------
    values, stderr : ndarray, shape (count, ...)
        Of every run; what stands beside each other must be independent.

    Returns
    -------
    ratio : float
    sigmas : float
        Quantile of the normal distribution with the same tail as the chi-square of the scatter.
    """
    true, stated = values.var(axis=0, ddof=1), (stderr**2).mean(axis=0)
    seen = stated > 0.0
    # What never scatters states no error.
    assert (true[~seen] == 0.0).all()
    freedom = np.count_nonzero(seen) * (len(values) - 1)
    statistic = ((len(values) - 1) * true[seen] / stated[seen]).sum()
    above, below = stats.chi2.sf(statistic, freedom), stats.chi2.cdf(statistic, freedom)
    sigmas = stats.norm.isf(above) if above < below else stats.norm.ppf(below)
    return float(np.sqrt(freedom / statistic)), float(sigmas)


def scatter_of_cells(energy, stderr, known):
    """Squared deviations from the mean of all runs over the squared stated errors, averaged over cells.

    Cells may share paths: the runs are what is independent, and their scatter tells the error of the average.

    Parameters
    ----------
    energy, stderr : ndarray, shape (count, ...)
        Of every run.
    known : float
        Cells count whose stated error is smaller than this share of the mean.

    Returns
    -------
    mean, error : float
    """
    count = len(energy)
    mean, stated = energy.mean(axis=0), np.sqrt((stderr**2).mean(axis=0))
    where = stated < known * mean
    squares = ((energy - mean)[:, where] / stated[where]) ** 2 * (count / (count - 1.0))
    per_run = squares.mean(axis=1)
    return float(per_run.mean()), float(per_run.std(ddof=1) / np.sqrt(count))
