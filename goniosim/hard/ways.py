"""One scene by every estimator that applies to it, and by many seeds."""

from collections.abc import Iterator

import numpy as np

from ..engine import simulate
from ..errors import ConfigError
from ..result import Result
from ..scene import Scene
from ..scene.model import Simulation
from .variants import varied

# The last digits of a result must not depend on it.
ESTIMATORS = [name for name in Simulation.model_fields["estimator"].annotation.__args__ if name != "auto"]


def by_estimator(scene: Scene, **given: object) -> Iterator[tuple[str, Result]]:
    """Simulate a scene by each estimator that applies to it.

    Parameters
    ----------
    scene : Scene
    **given
        For `goniosim.engine.simulate`.

    Yields
    ------
    name : str
    result : goniosim.result.Result
    """
    for name in ESTIMATORS:
        try:
            result = simulate(varied(scene, {"simulation.estimator": name}), **given)
        except ConfigError:
            continue
        yield name, result


def excess(values: np.ndarray, stderrs: np.ndarray, exact: float | np.ndarray | None = None) -> tuple[float, float]:
    """How far the scatter of values is from what their standard errors say.

    Parameters
    ----------
    values, stderrs : ndarray, shape (N, ...)
        By N seeds.
    exact : float or ndarray, optional
        The truth; without it, the mean over the seeds.

    Returns
    -------
    ratio : float
        Mean square of the deviations in standard errors, 1 if these are right.
    sigmas : float
        Its distance from 1 in its own standard errors, by the scatter of the squares.
    """
    seeds = len(values)
    known = exact is not None
    centre = exact if known else values.mean(axis=0)
    squares = np.divide((values - centre) ** 2, stderrs**2, out=np.zeros_like(values), where=stderrs > 0.0)
    if not known:
        squares *= seeds / (seeds - 1.0)
    # Numbers of one seed hang together: each seed counts once.
    each = squares.reshape(seeds, -1).mean(axis=1)
    ratio = float(each.mean())
    return ratio, float((ratio - 1.0) / (each.std(ddof=1) / seeds**0.5))
