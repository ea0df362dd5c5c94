"""Arguments of Python functions that stand for a value of the scene."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, get_args

from pydantic_core import PydanticCustomError

from goniosim.errors import ConfigError
from goniosim.scene.model import LIMITS, Rays, Scene, Seed, Simulation, Threads
from goniosim.scene.problems import closest, listed
from goniosim.scene.quantity import Checked, mistake
from goniosim.scene.target import Share, Target, TimeSpan
from goniosim.scene.tree import show


@dataclass(frozen=True)
class _OneOf(Checked):
    words: tuple[str, ...]

    def check(self, value: object) -> object:
        if value not in self.words:
            meant = closest(value, self.words)
            raise mistake(f"must be {listed(self.words, 'or')}" + (f"; did you mean {meant}?" if meant else ""))
        return value

    def json_schema(self) -> dict[str, Any]:
        return {"enum": list(self.words)}


ARGUMENTS: dict[str, Checked] = {
    "rays": Rays,
    "seed": Seed,
    "threads": Threads,
    "estimator": _OneOf(get_args(Simulation.model_fields["estimator"].annotation)),
    "target": Share(),
    "of": _OneOf(get_args(Target.model_fields["of"].annotation)),
    "max_rays": Rays,
    "max_time": TimeSpan(),
}
# By argument, the field of a target.
_TARGET = {"target": "relative_error", "of": "of"}


def with_arguments(scene: Scene, given: Mapping[str, object]) -> Scene:
    """Put arguments in the place of values of the scene.

    Parameters
    ----------
    scene : Scene
    given : mapping of str to object
        Names from `ARGUMENTS`; None leaves the value of the scene. A target, of which ``target`` is the relative
        error, takes the place of the rays of the scene, and rays that of its target and limits.

    Returns
    -------
    Scene

    Raises
    ------
    ConfigError
        With one line for each argument that is out of range, no number, or contradicts another.
    """
    accepted: dict[str, Any] = {}
    problems: list[str] = []
    for name, value in given.items():
        if value is None:
            continue
        value = value.tolist() if hasattr(value, "tolist") else value
        try:
            accepted[name] = ARGUMENTS[name].check(value)
        except PydanticCustomError as error:
            problems.append(f"{name} {error.message()} [got {show(value)}]")
    problems = problems or _contradictions(scene.simulation, accepted)
    if problems:
        raise ConfigError(problems)
    return scene.model_copy(update={"simulation": scene.simulation.model_copy(update=_changes(scene, accepted))})


def _contradictions(simulation: Simulation, accepted: Mapping[str, object]) -> list[str]:
    aimed = "target" in accepted or (simulation.target is not None and "rays" not in accepted)
    if "rays" in accepted and "target" in accepted:
        return ["rays must not stand beside target, which decides how many are traced: give one of them"]
    idle = [name for name in ("of", *LIMITS) if name in accepted]
    return [] if aimed else [f"{name} belongs to a target, and there is none: give target=0.01" for name in idle]


def _changes(scene: Scene, accepted: dict[str, Any]) -> dict[str, Any]:
    """What becomes of the fields of the simulation."""
    changes = {name: value for name, value in accepted.items() if name not in _TARGET}
    if "rays" in accepted:
        return {"target": None, **dict.fromkeys(LIMITS), **changes}
    if asked := {field: accepted[name] for name, field in _TARGET.items() if name in accepted}:
        before = scene.simulation.target
        changes["target"] = before.model_copy(update=asked) if before is not None else Target(**asked)
        changes["rays"] = None
    return changes
