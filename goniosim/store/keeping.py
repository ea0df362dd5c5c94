"""What may replace a result unasked: one of the same scene that is worth no less, or anything if it is damaged.

Rays are a measure of worth for results of the same estimator. Those of a target are not the same in all directions:
they went where they were needed, and count together. Results of different estimators, between which ``auto``
chooses, are worth what their noise says.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import h5py
import numpy as np

from goniosim.errors import (
    ConfigError,
    DamagedFileError,
    FewerRaysError,
    ForeignFileError,
    GoniosimError,
    NewerSchemaError,
    OutputError,
    UnreadableFileError,
    UnusableResultError,
)
from goniosim.result import Result
from goniosim.scene import Scene, Simulation, differences, parse_scene
from goniosim.scene.model import LIMITS, MAX_DIRECTIONS
from goniosim.scene.quantity import count
from goniosim.store import access
from goniosim.store.kinds import RESULT
from goniosim.store.layout import COMPONENTS
from goniosim.store.manifest import Manifest, NoManifest
from goniosim.store.opening import decoding, opened
from goniosim.store.output import reserve_output
from goniosim.store.reader import read_header
from goniosim.store.validation import MAX_CHECKPOINTS
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
    simulation : goniosim.scene.Simulation or None
        What the result was asked for, where ``rays`` are known.
    target_reached : bool or None
        Whether its target was reached; None if it had none.
    has_state : bool
        Whether an interrupted run of it can go on.
    estimator : str
        What made its sampled components.
    noise : float
        The largest of its components and directions, in sr^-1/2.
    """

    rays: np.ndarray | None = None
    differences: tuple[str, ...] = ()
    status: str = ""
    damage: str = ""
    simulation: Simulation | None = None
    target_reached: bool | None = None
    has_state: bool = False
    estimator: str = ""
    noise: float = 0.0

    def holds(self, asked: Simulation) -> bool:
        """Whether it is of the scene asked for, and gives what is asked for: the rays, or the accuracy.

        A target that was not reached counts for whoever asks for the same with the same limits, or narrower ones: to
        run it again would lead no further.
        """
        if self.rays is None or self.simulation is None:
            return False
        complete, target = self.status == "complete", self.simulation.target
        if asked.target is None:
            spread = complete and target is not None and self.rays.mean() >= asked.most_rays
            return spread or bool((self.rays >= asked.most_rays).all())
        if not complete or target is None:
            return False
        if self.target_reached:
            return asked.target.is_met_by(target)
        return asked.target == target and _are_narrower(asked, self.simulation)

    def is_resumed_by(self, asked: Simulation) -> bool:
        """Whether it is what an interrupted run left of just what is asked for; threads and limits may be others."""
        if not self.has_state or self.simulation is None:
            return False
        free = dict.fromkeys((*LIMITS, "threads"))
        return asked.model_copy(update=free) == self.simulation.model_copy(update=free)

    def outweighs(self, result: Result) -> bool:
        """Whether it is of the scene of a result and worth more: by its rays, or its noise if the estimators differ.

        Without noise it saw nothing, and is worth no more than one that saw something.
        """
        if self.rays is None:
            return False
        if self.estimator == result.estimator:
            return bool(self.rays.sum() > result.rays.sum())
        return not result.rays.all() or 0.0 < self.noise < _noise_of(result)


def look_at(path: StrPath, scene: Scene | None, result: Result | None = None) -> Standing | None:
    """See what stands at the place of an output.

    Cheap, unless it is to stay: then every byte of the file is checked, so that nobody relies on a damaged one.

    Parameters
    ----------
    path : path-like
    scene : Scene or None
        What is asked for; None if ``config_yaml`` cannot be read.
    result : Result, optional
        That is to go there. Without it, it is still to be made.

    Returns
    -------
    Standing or None
        None if nothing stands there.

    Raises
    ------
    OutputError
        If it is not a result, one that only a newer goniosim can read, or one that cannot be read at all now.
    """
    try:
        header = read_header(path)
        there = str(header.get("config_yaml", ""))
        found = () if result is not None and there == result.config_yaml else _differences(there, scene)
        if found:
            return Standing(differences=found)
        standing = _standing(path, header)
        if standing.outweighs(result) if result is not None else scene is not None and standing.holds(scene.simulation):
            _verify(path)
    except DamagedFileError as error:
        return Standing(damage=str(error))
    except (NewerSchemaError, UnreadableFileError) as error:
        raise _not_overwritten(error) from error
    except (ForeignFileError, UnusableResultError):
        # Nothing, or something that is none of ours: this tells.
        reserve_output(path, 0).release()
        return None
    return standing


def refuse_newer(path: StrPath) -> None:
    """Raise an OutputError if the result at a path is one that only a newer goniosim can read."""
    try:
        read_header(path)
    except NewerSchemaError as error:
        raise _not_overwritten(error) from error
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
        A sound result of the same scene that is worth more.
    OutputError
        A result of another scene, or no result.
    """
    found = look_at(path, _scene(result.config_yaml), result)
    if found is None or found.damage:
        return
    if found.rays is None:
        raise OutputError(
            f"{path}: holds the result of another scene ({'; '.join(found.differences)}), so it is not overwritten; "
            "choose another name, or allow overwriting"
        )
    if found.outweighs(result):
        more = ""
        if found.estimator != result.estimator:
            more = f", by {found.estimator} with a noise of {found.noise:.2g} sr^-1/2, by {result.estimator} with "
            more += f"{_noise_of(result):.2g}"
        raise FewerRaysError(path, count(found.rays.mean()), count(result.rays.mean()), more)


def _noise_of(result: Result) -> float:
    return max((float(error[:, -1].max()) for error in result.cost.error.values() if error.size), default=0.0)


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


def _standing(path: StrPath, header: Mapping[str, str | int]) -> Standing:
    scene = _scene(str(header["config_yaml"]))
    reached = header.get("target_reached")
    rays, has_state, noise = _look_into(path)
    return Standing(
        rays=rays,
        has_state=has_state,
        estimator=str(header.get("estimator", "")),
        noise=noise,
        status=str(header["status"]),
        simulation=scene.simulation if scene else None,
        target_reached=None if reached is None else bool(reached),
    )


def _are_narrower(limits: Simulation, others: Simulation) -> bool:
    """Whether each limit of a target is that of another one, or narrower."""
    pairs = [(getattr(limits, name) or math.inf, getattr(others, name) or math.inf) for name in LIMITS]
    return all(one <= other for one, other in pairs)


def _verify(path: StrPath) -> None:
    """Check every byte of a result file without decoding it."""
    with opened(path, RESULT):
        pass


def _look_into(path: StrPath) -> tuple[np.ndarray, bool, float]:
    """Rays traced from each direction, shape (M,), whether there is a state, and the noise; not the whole file."""
    with opened(path, RESULT, whole=False) as (file, ours), decoding(path, RESULT.remedy):
        rays = access.dataset(file, "incident/rays")
        # Read only what cannot be huge.
        if len(rays.shape) == 1 and rays.shape[0] <= MAX_DIRECTIONS:
            return access.read(rays).astype(np.int64, casting="safe"), ours.has("state"), _noise(file, ours)
    raise DamagedFileError(f"{path}: does not say how many rays were traced; {RESULT.remedy}")


def _noise(file: h5py.File, ours: Manifest | NoManifest) -> float:
    found = 0.0
    for path in (f"cost/error_{name.replace('/', '_')}" for name in COMPONENTS):
        error = access.dataset(file, path) if ours.has(path) else None
        if error is not None and error.size and error.size <= MAX_DIRECTIONS * MAX_CHECKPOINTS:
            found = max(found, float(access.read(error)[..., -1].max()))
    return found


def _not_overwritten(error: GoniosimError) -> OutputError:
    return OutputError(f"{error}; the file is not overwritten")
