"""The whole price list of a scene, measured within a given time."""

from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ...cores import granted_threads
from ...engine import shortage, threads_of
from .cells import finer_scene, lost_to_cells
from .directions import dense_scene, lost_between
from .effects import added
from .fit import fit
from .ladder import FIRST, climb
from .models import model_points
from .nodes import node_bias
from .prices import prices
from .runs import ESTIMATORS, run
from .subcells import subcell_errors

# Shares of the time: of each estimator's ladder, and of each of the other parts.
LADDER, PART = 0.3, 0.12


@dataclass(frozen=True)
class Component:
    """What the accuracy of one sampled component costs.

    Attributes
    ----------
    norm : ndarray, shape (M,)
        Of the slices, in 1/sr^(1/2).
    laws : dict of str to Law
        By estimator.
    prices : dict of str to list of Price
        By estimator, from easy to hard; empty where the component is black.
    used : dict of str to list of str
        By what the estimator asked for went about, for each direction.
    models : dict of str to dict
        See `models.model_points`.
    """

    norm: np.ndarray
    laws: dict
    prices: dict
    used: dict
    models: dict = field(default_factory=dict)


@dataclass(frozen=True)
class PriceList:
    """What accuracy costs for one scene.

    Attributes
    ----------
    scene : goniosim.scene.Scene
    threads : int
    ladders : dict of str to list of Run
        By estimator.
    components : dict of str to Component
        The sampled ones.
    effects : dict of str to Added
    subcells, cells, directions : dict
        What limits besides noise, see `subcells`, `cells` and `directions`.
    nodes : dict of str to float
        By component, what the nodes of an operator may be off by, relative to the slice, in the worst direction.
    """

    scene: object
    threads: int
    ladders: dict
    components: dict
    effects: dict
    subcells: dict
    cells: dict
    directions: dict
    nodes: dict


def price_list(scene, max_seconds, models=False, say=lambda message: None):
    """Measure the price list.

    Parameters
    ----------
    scene : goniosim.scene.Scene
    max_seconds : float
        Time to spend, about: compilation is not in it, and each part does the least that says something.
    models : bool
        Whether to compare the models as well, which takes its own time.
    say : callable
        Called with a line on what is being done.

    Returns
    -------
    PriceList
    """
    ladders = climb(scene, LADDER * max_seconds, say)
    best = {estimator: rungs[-1] for estimator, rungs in ladders.items()}
    points = {}
    if models:
        say("models")
        points = model_points(best[ESTIMATORS[0]].result)
    say("effects")
    effects = added(scene, PART * max_seconds)
    say("sub-cells")
    subcells = subcell_errors(scene)
    say("cells")
    cells = _limit(finer_scene(scene), best, PART * max_seconds, lost_to_cells)
    say("directions")
    directions = _limit(dense_scene(scene), best, PART * max_seconds, partial(lost_between, scene))
    return PriceList(
        scene=scene,
        threads=granted_threads(threads_of(scene)),
        ladders=ladders,
        components=_components(ladders, points),
        effects=effects,
        subcells=subcells,
        cells=cells,
        directions=directions,
        nodes=node_bias(best[ESTIMATORS[0]]),
    )


def _components(ladders, points):
    components = {}
    for name in ladders[ESTIMATORS[0]][-1].noise:
        # The least noisy run knows the norm best.
        norm = min((rungs[-1] for rungs in ladders.values()), key=lambda rung: rung.noise[name].sum()).norm[name]
        laws = {each: fit(rungs, name, norm, each == "analog") for each, rungs in ladders.items()}
        components[name] = Component(
            norm=norm,
            laws=laws,
            prices={each: prices(law) for each, law in laws.items()},
            used={each: rungs[-1].estimators[name] for each, rungs in ladders.items()},
            models=points.get(name, {}),
        )
    return components


def _limit(scene, best, seconds, look):
    """What ``look`` tells of a result of another scene, with as many rays as some seconds allow.

    Nothing where there is no such scene, where nothing is sampled, or where memory is short.
    """
    estimator = ESTIMATORS[0]
    rung = best[estimator]
    if scene is None or not rung.noise or shortage(scene):
        return {}
    per_ray = rung.seconds.sum() / rung.rays.sum()
    rays = seconds / (per_ray * len(scene.incident.theta_deg))
    return look(run(scene, estimator, max(FIRST[estimator], int(rays))).result)
