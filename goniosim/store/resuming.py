"""Partial results while a run goes on, and what an interrupted run left at the place of its output."""

from collections.abc import Callable

import numpy as np

from goniosim.errors import FewerRaysError, OutputError
from goniosim.result import Result
from goniosim.scene import Scene
from goniosim.store.keeping import look_at
from goniosim.store.reader import open_result, read_state
from goniosim.store.saving import write_result
from goniosim.writing import StrPath


def keeper(
    path: StrPath, overwrite: bool = False, failed: Callable[[OutputError], None] = lambda _: None
) -> Callable[[Result], None]:
    """What writes a partial result to a path, time and again.

    Parameters
    ----------
    path : path-like
    overwrite : bool
        As for `write_result`.
    failed : callable
        Called with the error if it cannot be written: the run goes on all the same.

    Returns
    -------
    callable
        Called with a `goniosim.result.Result`; it leaves alone what is worth more.
    """

    def keep(result: Result) -> None:
        try:
            write_result(result, path, overwrite=overwrite, rescued=False)
        except FewerRaysError:
            pass
        except OutputError as error:
            failed(error)

    return keep


def state_left(path: StrPath, scene: Scene) -> tuple[bytes, np.ndarray] | None:
    """What an interrupted run of just this scene and simulation left at a path.

    Parameters
    ----------
    path : path-like
    scene : goniosim.scene.Scene

    Returns
    -------
    (bytes, ndarray of int64, shape (M,)) or None
        As `goniosim.engine.simulate` takes it, and the rays of each direction; None if there is none.

    Raises
    ------
    DamagedFileError
        If the file was altered.
    OutputError
        If something that is no result stands there.
    """
    standing = look_at(path, scene)
    if standing is None or standing.rays is None or not standing.is_resumed_by(scene.simulation):
        return None
    state = read_state(path)
    return None if state is None else (state, standing.rays)


def result_left(path: StrPath, scene: Scene) -> Result | None:
    """The result of the same scene at a path, with less in it than is asked for: a run may go on from there.

    Parameters
    ----------
    path : path-like
    scene : goniosim.scene.Scene

    Returns
    -------
    goniosim.result.Result or None
        None if there is none, or nothing in it.

    Raises
    ------
    DamagedFileError
        If the file was altered.
    OutputError
        If something that is no result stands there.
    """
    standing = look_at(path, scene)
    if standing is None or standing.rays is None or not standing.rays.any():
        return None
    return open_result(path)
