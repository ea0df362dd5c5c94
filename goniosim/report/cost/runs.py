"""One run of a ladder: how noisy its slices are, and what they cost. All that is known here of the engine's answer."""

import time
from dataclasses import dataclass

import numpy as np

from ...engine import simulate
from .norms import noise_of, norm_of

ESTIMATORS = ("auto", "analog")


@dataclass(frozen=True)
class Run:
    """What one simulation says of its price.

    Attributes
    ----------
    rays : ndarray, shape (M,)
        Light paths from each direction.
    seconds, cpu_seconds : ndarray, shape (M,)
        Time of tracing, by direction.
    overhead, cpu_overhead : float
        Time of all the rest: direct reflection, cells, error bars.
    noise : dict of str to ndarray, shape (M,)
        Of each sampled component, norm of Eq. 4 (Bati et al. 2019) of the standard error, in 1/sr^(1/2), the mean
        over the channels.
    norm : dict of str to ndarray, shape (M,)
        The same of the slice, its noise taken out.
    estimators : dict of str to list of str
        What was used for each direction.
    result : goniosim.result.Result
    """

    rays: np.ndarray
    seconds: np.ndarray
    cpu_seconds: np.ndarray
    overhead: float
    cpu_overhead: float
    noise: dict
    norm: dict
    estimators: dict
    result: object


def run(scene, estimator, rays, seed=None, threads=None):
    """Simulate a scene and take the time.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    estimator : str
        One of `ESTIMATORS`.
    rays : int
        Per direction.
    seed, threads : int, optional

    Returns
    -------
    Run
    """
    start, cpu_start = time.perf_counter(), time.process_time()
    result = simulate(asked(scene, estimator, rays), seed=seed, threads=threads)
    elapsed, cpu_elapsed = time.perf_counter() - start, time.process_time() - cpu_start
    seconds, cpu_seconds = result.cost.seconds[:, -1], result.cost.cpu_seconds[:, -1]
    found = sampled(result)
    return Run(
        rays=result.rays.astype(float),
        seconds=seconds,
        cpu_seconds=cpu_seconds,
        overhead=max(elapsed - seconds.sum(), 0.0),
        cpu_overhead=max(cpu_elapsed - cpu_seconds.sum(), 0.0),
        noise={name: noise_of(component, result.cells) for name, component in found.items()},
        norm={name: norm_of(component, result.cells) for name, component in found.items()},
        estimators={name: component.estimator for name, component in found.items()},
        result=result,
    )


def asked(scene, estimator, rays):
    """The scene with so many rays, by an estimator."""
    given = {"rays": rays, "target": None, "max_rays": None, "max_time": None, "estimator": estimator}
    return scene.model_copy(update={"simulation": scene.simulation.model_copy(update=given)})


def sampled(result):
    """The components of a result that paths made: all but the direct reflection, which is integrated."""
    return {name: component for name, component in result.components.items() if name != "reflection/direct"}
