"""Arguments of Python functions that stand for a value of the scene."""

from collections.abc import Mapping

from pydantic_core import PydanticCustomError

from goniosim.errors import ConfigError
from goniosim.scene.model import Rays, Scene, Seed, Threads
from goniosim.scene.tree import show

ARGUMENTS = {"rays": Rays, "seed": Seed, "threads": Threads}


def with_arguments(scene: Scene, given: Mapping[str, object]) -> Scene:
    """Put arguments in the place of values of the scene.

    Parameters
    ----------
    scene : Scene
    given : mapping of str to object
        Names from `ARGUMENTS`; None leaves the value of the scene.

    Returns
    -------
    Scene

    Raises
    ------
    ConfigError
        With one line for each argument that is out of range or no number.
    """
    accepted: dict[str, object] = {}
    problems: list[str] = []
    for name, value in given.items():
        if value is None:
            continue
        value = value.tolist() if hasattr(value, "tolist") else value
        try:
            accepted[name] = ARGUMENTS[name].check(value)
        except PydanticCustomError as error:
            problems.append(f"{name} {error.message()} [got {show(value)}]")
    if problems:
        raise ConfigError(problems)
    return scene.model_copy(update={"simulation": scene.simulation.model_copy(update=accepted)})
