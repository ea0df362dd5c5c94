"""Scene files in, scenes out."""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from goniosim.errors import ConfigError
from goniosim.scene.checking import check
from goniosim.scene.model import Scene
from goniosim.scene.overrides import override
from goniosim.scene.problems import config_error
from goniosim.scene.reading import read_file, read_text
from goniosim.scene.study import study_scenes
from goniosim.scene.tree import Node, Origin, from_plain, locate, plain


def load_scene(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> Scene:
    """Load a scene file that describes one material.

    Parameters
    ----------
    path : str or Path
    overrides : iterable of str
        Changes such as ``simulation.rays=1e6``, applied before anything is checked.

    Returns
    -------
    Scene

    Raises
    ------
    ConfigError
        With one line for each mistake, ``file:line: field: message``.
    """
    return _one_scene(override(read_file(path), overrides))


def load_scenes(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> list[Scene]:
    """Load a scene file or a study file.

    Parameters
    ----------
    path : str or Path
    overrides : iterable of str
        Changes such as ``simulation.rays=1e6``, applied before a study is expanded.

    Returns
    -------
    list of Scene
        One for each material, in the order of the study.

    Raises
    ------
    ConfigError
        With one line for each mistake, ``file:line: field: message``.
    """
    root = override(read_file(path), overrides)
    return study_scenes(root) if "study" in root.value else [_one_scene(root)]


def parse_scene(content: str | dict[str, Any], source: str = "<string>", overrides: Iterable[str] = ()) -> Scene:
    """Make a scene of YAML text or of a dict with the same content.

    Parameters
    ----------
    content : str or dict
    source : str
        What error messages call it.
    overrides : iterable of str
        Changes such as ``simulation.rays=1e6``, applied before anything is checked.

    Returns
    -------
    Scene

    Raises
    ------
    ConfigError
        With one line for each mistake; ``source:line`` in front where there is text.
    """
    if isinstance(content, dict):
        try:
            root = from_plain(content, Origin(source, 0))
        except RecursionError:
            raise ConfigError(f"{source}: is nested too deeply for a scene") from None
    else:
        root = read_text(content, source)
    return _one_scene(override(root, overrides))


@dataclass(frozen=True)
class Config:
    """What a scene or study file describes.

    Attributes
    ----------
    scenes : list of Scene
        One for each material, in the order of the study.
    study : str or None
        Name of the study, after which the folder of its results is called; None for a single material.
    """

    scenes: list[Scene]
    study: str | None


def load_config(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> Config:
    """Load a scene file or a study file with its name, reading it once.

    Parameters
    ----------
    path : str or Path
        ``-`` is the standard input.
    overrides : iterable of str
        Changes such as ``simulation.rays=1e6``, applied before a study is expanded.

    Returns
    -------
    Config

    Raises
    ------
    ConfigError
        With one line for each mistake, ``file:line: field: message``.
    """
    root = override(read_file(path), overrides)
    if "study" not in root.value:
        return Config([_one_scene(root)], None)
    return Config(study_scenes(root), plain(locate(root, ("study", "name"))[0]))


def _one_scene(root: Node) -> Scene:
    if "study" in root.value:
        raise config_error(
            [
                root.value["study"].problem(
                    "this file describes several materials, and one is needed here: "
                    "give a file with material, or use load_scenes",
                    got=False,
                )
            ]
        )
    scene, problems = check(root)
    if scene is None:
        raise config_error(problems)
    return scene
