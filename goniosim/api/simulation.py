"""One simulation: the engine, with Ctrl-C and progress."""

import threading
from typing import Any

from ..errors import ConfigError, StoppedError
from ..result import Result
from ..scene import Scene, Source, as_scene, with_arguments
from .progress import Progress, progress_of
from .stopping import Stop


def simulate(
    scene: Scene | Source,
    *,
    rays: float | None = None,
    seed: float | None = None,
    threads: int | None = None,
    estimator: str | None = None,
    target: float | str | None = None,
    of: str | None = None,
    max_rays: float | None = None,
    max_time: float | str | None = None,
    progress: Progress = None,
    stop: threading.Event | None = None,
) -> Result:
    """Simulate the goniometer measurement of one material.

    Ctrl-C, or the stop button of a notebook, returns what was gathered, as a result with status
    ``partial``; before the first rays, or pressed twice, it raises KeyboardInterrupt. In other threads than the main
    one Python has no Ctrl-C: use ``stop``.

    Parameters
    ----------
    scene : goniosim.scene.Scene, path, mapping or str
        What to simulate: a scene, or what `load_scene` takes.
    rays : int, optional
        Rays per incident direction, instead of the scene's; 1e6 is as good as 1000000.
    seed : int, optional
        Seed of the random numbers, instead of the scene's. The same seed gives the same bits for any number of threads.
    threads : int, optional
        Threads to use, instead of the scene's (or of all processors).
    estimator : {"auto", "analog", "split", "operator", "connection"}, optional
        How to estimate, instead of the scene's.
    target : float or str, optional
        Stop once the relative error is this small in every direction and component: ``0.01`` or ``"1%"``. It takes
        the place of ``rays``.
    of : {"slice", "albedo", "cells"}, optional
        What the target is the error of, instead of the scene's: of the slice (default), of its energy, or of 95 % of
        the cells that hold 95 % of it.
    max_rays : int, optional
        Rays per incident direction at most, where there is a target.
    max_time : float or str, optional
        Time at most, where there is a target: seconds, or ``"90s"``, ``"10m"``, ``"1h30m"``.
    progress : bool or callable, optional
        True for a progress bar; or a function, called as ``progress(done_rays, total_rays)`` a few times a
        second, with None in the place of the total where a target decides.
    stop : threading.Event, optional
        Once set, tracing ends within about a second.

    Returns
    -------
    goniosim.result.Result
        With status ``partial`` if it was ended early. Its ``target_reached`` is False if one of the limits came first.

    Raises
    ------
    goniosim.errors.ConfigError
        The scene, or one of the other arguments, is wrong; with one line for each mistake.
    goniosim.errors.StoppedError
        ``stop`` was set before there was anything to keep.
    KeyboardInterrupt
        Ctrl-C before there was anything to keep, or pressed twice.

    Examples
    --------
    >>> goniosim.simulate("scene.yaml", rays=1e4)
    <Result coated (complete)
      incident theta [deg]: 0, 60
      classic slices of 9 x 36 cells, channels R, G, B
      rays per direction: 1e4, seed 1
      mean albedo: reflection/direct 0.05577, reflection/internal 0.2567 ± 0.0013>
    """
    given = {
        "rays": rays,
        "seed": seed,
        "threads": threads,
        "estimator": estimator,
        "target": target,
        "of": of,
        "max_rays": max_rays,
        "max_time": max_time,
    }
    scene = with_arguments(as_scene(scene), given)
    check_stop(stop)
    with progress_of(progress, scene.total_rays) as shown, Stop(stop) as asked:
        try:
            return trace(scene, scene.material.name, shown, asked)
        except StoppedError:
            if asked.interrupted:
                raise KeyboardInterrupt from None
            raise


def trace(scene: Scene, label: str, shown: Any, asked: Stop, **kept: Any) -> Result:
    """Simulate one scene; from the first rays on there may be something to keep, see ``kept`` of the engine."""
    from .. import engine

    began = False

    def report(done_rays: int, total_rays: int | None) -> None:
        nonlocal began
        if not began:
            began = asked.gathering = True
            shown.begin(label, inherited=done_rays if {"resume", "prior"} & kept.keys() else 0)
        shown.update(done_rays, total_rays)

    def tell(outlook: Any) -> None:
        from ..report.simulation.target import far

        shown.note(f"{label}: {far(scene.simulation, outlook)}")

    result: Result = engine.simulate(scene, progress=report, stop=asked, tell=tell, **kept)
    return result


def check_stop(stop: object) -> None:
    """Raise a ConfigError for anything but an event."""
    if stop is not None and not isinstance(stop, threading.Event):
        raise ConfigError(f"stop must be a threading.Event [got {stop!r}]")
