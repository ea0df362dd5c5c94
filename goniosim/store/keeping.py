"""What may replace a result unasked: one of the same scene that has no fewer rays, or anything if it is damaged."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from goniosim.errors import (
    ConfigError,
    DamagedFileError,
    FewerRaysError,
    ForeignFileError,
    GoniosimError,
    NewerSchemaError,
    OutputError,
    UnusableResultError,
)
from goniosim.result import Result
from goniosim.scene import Scene, differences, parse_scene
from goniosim.scene.model import MAX_DIRECTIONS
from goniosim.scene.quantity import count
from goniosim.store import access
from goniosim.store.kinds import RESULT
from goniosim.store.opening import decoding, opened
from goniosim.store.output import reserve_output
from goniosim.store.reader import read_header
from goniosim.writing import StrPath


@dataclass(frozen=True)
class Standing:
    """A result that stands where another is to go.

    Attributes
    ----------
    rays : ndarray of int64, shape (M,), or None
        Traced from each direction; None if the file is damaged or of another scene.
    differences : list of str
        What its scene differs in from the one asked for, see `goniosim.scene.differences`.
    status : str
        ``complete`` or ``partial``, where ``rays`` are known.
    damage : str
        What is wrong with the file, if it is damaged.
    """

    rays: np.ndarray | None = None
    differences: tuple[str, ...] = ()
    status: str = ""
    damage: str = ""

    def holds(self, rays: ArrayLike) -> bool:
        """Whether it is of the scene asked for, with at least so many rays from every direction."""
        return self.rays is not None and bool((self.rays >= np.asarray(rays)).all())


def look_at(path: StrPath, scene: Scene | None, rays: ArrayLike, config_yaml: str = "") -> Standing | None:
    """See what stands at the place of an output.

    Cheap, unless the file holds as much as is asked for: then every byte of it is checked, so that nobody relies on
    a damaged one.

    Parameters
    ----------
    path : path-like
    scene : Scene or None
        What is asked for; None if ``config_yaml`` cannot be read.
    rays : int or ndarray of int64, shape (M,)
        Rays per direction that are asked for.
    config_yaml : str
        A text that stands for the scene too.

    Returns
    -------
    Standing or None
        None if nothing stands there.

    Raises
    ------
    OutputError
        If it is not a result, or one that only a newer goniosim can read.
    """
    try:
        header = read_header(path)
        there = str(header.get("config_yaml", ""))
        found = () if there == config_yaml else _differences(there, scene)
        if found:
            return Standing(differences=found)
        traced = _rays(path)
        if (traced >= np.asarray(rays)).any():
            _verify(path)
    except DamagedFileError as error:
        return Standing(damage=str(error))
    except NewerSchemaError as error:
        raise _newer(error) from error
    except (ForeignFileError, UnusableResultError):
        # Nothing, or something that is none of ours: this tells.
        reserve_output(path, 0).release()
        return None
    return Standing(traced, status=str(header["status"]))


def refuse_newer(path: StrPath) -> None:
    """Raise an OutputError if the result at a path is one that only a newer goniosim can read."""
    try:
        read_header(path)
    except NewerSchemaError as error:
        raise _newer(error) from error
    except GoniosimError:
        # Nothing there, or nothing to lose.
        pass


def check_replacement(path: StrPath, result: Result) -> None:
    """Make sure that a result may replace what stands at a path, which nobody was asked about.

    Parameters
    ----------
    path : path-like
    result : goniosim.result.Result

    Raises
    ------
    FewerRaysError
        A sound result of the same scene with more rays from some direction.
    OutputError
        A result of another scene, or no result.
    """
    found = look_at(path, _scene(result.config_yaml), result.rays, result.config_yaml)
    if found is None or found.damage:
        return
    if found.rays is None:
        raise OutputError(
            f"{path}: holds the result of another scene ({'; '.join(found.differences)}), so it is not overwritten; "
            "choose another name, or allow overwriting"
        )
    if (found.rays > result.rays).any():
        raise FewerRaysError(path, count(found.rays.max()), count(result.rays.max()))


def _differences(there: str, asked: Scene | None) -> tuple[str, ...]:
    scene = _scene(there)
    if scene is None or asked is None:
        return ("the scene is not one that this goniosim can read",)
    return tuple(differences(scene, asked))


def _scene(config_yaml: str) -> Scene | None:
    try:
        return parse_scene(config_yaml)
    except ConfigError:
        return None


def _verify(path: StrPath) -> None:
    """Check every byte of a result file without decoding it."""
    with opened(path, RESULT):
        pass


def _rays(path: StrPath) -> np.ndarray:
    """Rays traced from each direction, shape (M,), without reading the whole file."""
    with opened(path, RESULT, whole=False) as (file, _), decoding(path, RESULT.remedy):
        rays = access.dataset(file, "incident/rays")
        # Read only what cannot be huge.
        if len(rays.shape) == 1 and rays.shape[0] <= MAX_DIRECTIONS:
            return access.read(rays).astype(np.int64, casting="safe")
    raise DamagedFileError(f"{path}: does not say how many rays were traced; {RESULT.remedy}")


def _newer(error: NewerSchemaError) -> OutputError:
    return OutputError(f"{error}; the file is not overwritten")
