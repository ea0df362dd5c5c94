"""Compiled code, kept ready before it is needed: by one process, while others that want it wait and then load it."""

import contextlib
import time
from dataclasses import dataclass
from pathlib import Path

from goniosim._jit.folder import CACHE_FOLDER, notices
from goniosim.errors import RefusalError
from goniosim.parts import turn

# Seconds that another process may take to compile everything on a slow and busy machine.
PATIENCE = 600.0


@dataclass(frozen=True)
class Warmth:
    """What it took to have the kernels ready.

    Attributes
    ----------
    folder : Path
        The cache.
    kernels : int
        Files of machine code that it holds.
    compiled : int
        How many of them are new.
    seconds : float
        Time that compiling and loading took.
    waited : float
        Seconds before, in which another process had its turn.
    """

    folder: Path
    kernels: int
    compiled: int
    seconds: float
    waited: float


def keep_warm(scenes):
    """Compile all kernels that the simulations of scenes take, unless the cache has them.

    Parameters
    ----------
    scenes : list of goniosim.scene.Scene

    Returns
    -------
    Warmth

    Raises
    ------
    RefusalError
        If no folder takes compiled code.
    """
    if CACHE_FOLDER is None:
        raise RefusalError(f"there is no place to keep compiled code: {'; '.join(notices)}; name one: NUMBA_CACHE_DIR")
    asked = time.monotonic()
    with turn(CACHE_FOLDER, PATIENCE):
        start = time.monotonic()
        before = _kernels()
        _simulate(scenes)
        after = _kernels()
        return Warmth(CACHE_FOLDER, len(after), len(after - before), time.monotonic() - start, start - asked)


def of_all_estimators():
    """Scenes that take all kernels between them.

    Returns
    -------
    list of goniosim.scene.Scene
    """
    from goniosim.scene import example, parse_scene

    # Independent paths are everywhere, in the energy balance.
    asked = {"plastic": ("auto", "split"), "metal": ("auto",), "quickstart": ("auto",), "slab": ("auto",)}
    return [
        parse_scene(example(name), overrides=[f"simulation.estimator={estimator}"])
        for name, estimators in asked.items()
        for estimator in estimators
    ]


def _kernels():
    with contextlib.suppress(OSError):
        return {path.name for path in CACHE_FOLDER.rglob("*.nbc")}
    return set()


def _simulate(scenes):
    from goniosim.engine import simulate

    # What follows from the numbers in a scene is no matter of compilation.
    for scene in {_kind(scene): scene for scene in scenes}.values():
        simulate(_tiny(scene), threads=1)


def _kind(scene):
    from goniosim.engine import estimators_of

    interfaces = tuple((each.type, getattr(each, "alpha", None) == 0.0) for each in scene.material.interfaces)
    return interfaces, scene.simulation.orders is None, *estimators_of(scene)


def _tiny(scene):
    """The scene with as little to do as runs the same kernels."""
    from goniosim.engine.rounds import FEWEST_PATHS

    asked = scene.simulation
    rays = {"rays": min(asked.most_rays, FEWEST_PATHS), "target": None, "max_rays": None, "max_time": None}
    changes = {
        "incident": type(scene.incident)(theta_deg=scene.incident.theta_deg[:1]),
        "slice": type(scene.slice)(parametrization=scene.slice.parametrization, rows=6, columns=12),
        "simulation": asked.model_copy(update=rays),
    }
    return scene.model_copy(update=changes)
