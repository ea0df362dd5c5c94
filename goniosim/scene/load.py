"""Scene files in, scenes out."""

import os
from collections.abc import Iterable
from typing import Any

from goniosim.errors import ConfigError
from goniosim.scene.checking import check
from goniosim.scene.model import Scene
from goniosim.scene.overrides import override
from goniosim.scene.problems import config_error
from goniosim.scene.reading import read_file, read_text
from goniosim.scene.study import study_scenes
from goniosim.scene.tree import Node, Origin, from_plain, locate


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


def is_study(path: str | os.PathLike[str]) -> bool:
    """Tell whether a file describes a study of several materials.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    bool

    Raises
    ------
    ConfigError
        Unreadable or not YAML.
    """
    return "study" in read_file(path).value


def study_name(path: str | os.PathLike[str]) -> str | None:
    """Return the name of a study, after which its folder of results is called.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    str or None
        None for a file that describes a single material, and for a study whose name is not text.

    Raises
    ------
    ConfigError
        Unreadable or not YAML.
    """
    node, rest = locate(read_file(path), ("study", "name"))
    return node.value if not rest and isinstance(node.value, str) else None


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
