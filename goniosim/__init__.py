"""goniosim, a virtual goniometer: Monte Carlo BRDF and BTDF slices of layered materials.

>>> import goniosim
>>> result = goniosim.simulate("configs/quickstart.yaml")            # doctest: +SKIP
>>> result.components["reflection/internal"].bsdf.shape              # doctest: +SKIP
(7, 3, 90, 360)

Importing the package loads nothing heavy: each name brings its own machinery when first used.
"""

from __future__ import annotations

from importlib import import_module as _import_module
from typing import TYPE_CHECKING as _TYPE_CHECKING

if _TYPE_CHECKING:
    import os
    import threading
    from collections.abc import Callable

    from goniosim.compare import compare
    from goniosim.models import evaluate_model
    from goniosim.result import Result
    from goniosim.scene import Scene, load_scene
    from goniosim.store import open_result

    __version__: str

__all__ = ["__version__", "compare", "evaluate_model", "load_scene", "open_result", "simulate"]

_HOMES = {
    "evaluate_model": "goniosim.models",
    "load_scene": "goniosim.scene",
    "open_result": "goniosim.store",
}


def simulate(
    scene: Scene | str | os.PathLike[str],
    *,
    rays: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
    stop: threading.Event | None = None,
) -> Result:
    """Simulate the goniometer measurement of one material.

    Parameters
    ----------
    scene : goniosim.scene.Scene or path
        What to simulate; a path is read with `load_scene`.
    rays : int, optional
        Rays per incident direction, instead of the scene's.
    seed : int, optional
        Seed of the random numbers, instead of the scene's.
    threads : int, optional
        Threads to use, instead of the scene's (or of all processors).
    progress : callable, optional
        Called as ``progress(done_rays, total_rays)`` a few times a second.
    stop : threading.Event, optional
        Once set, tracing ends within about a second.

    Returns
    -------
    goniosim.result.Result
        With status ``partial`` if ``stop`` ended it early.

    Raises
    ------
    goniosim.errors.ConfigError
        The scene file, or one of the other arguments, is wrong.
    goniosim.errors.StoppedError
        It was stopped before there was anything to keep.
    """
    from goniosim import engine
    from goniosim import scene as scenes

    if not isinstance(scene, scenes.Scene):
        scene = scenes.load_scene(scene)
    return engine.simulate(scene, rays=rays, seed=seed, threads=threads, progress=progress, stop=stop)


def __getattr__(name: str) -> object:
    if name in _HOMES:
        value = getattr(_import_module(_HOMES[name]), name)
    elif name == "compare":
        # The package itself, which can be called.
        value = _import_module("goniosim.compare")
    elif name == "__version__":
        value = _import_module("importlib.metadata").version("goniosim")
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
