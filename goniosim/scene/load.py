"""Scene files in, scenes out."""

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from goniosim.errors import ConfigError
from goniosim.scene.checking import check
from goniosim.scene.model import Scene
from goniosim.scene.overrides import Override, override
from goniosim.scene.problems import config_error
from goniosim.scene.reading import read_file, read_text
from goniosim.scene.study import study_scenes
from goniosim.scene.tree import Node, Origin, from_plain, locate, plain, show

Source = str | os.PathLike[str] | Mapping[str, Any]

# What messages call text that comes without a file.
TEXT = "<string>"


def load_scene(source: Source, overrides: Iterable[str | Override] = ()) -> Scene:
    """Load a scene that describes one material.

    Parameters
    ----------
    source : path, mapping or str
        A scene file; or what such a file holds, as a dict or as YAML text (recognised by a line break).
        In a dict arrays of numpy are as good as lists.
    overrides : iterable of str
        Changes such as ``simulation.rays=1e6``, applied before anything is checked.

    Returns
    -------
    Scene

    Raises
    ------
    ConfigError
        With one line for each mistake: ``file:line: field: message``, or ``field: message`` for a mapping.

    Examples
    --------
    >>> goniosim.load_scene(
    ...     {
    ...         "material": {
    ...             "name": "gold",
    ...             "layers": [{"interface": {"type": "conductor", "eta": 0.2, "kappa": [3.9, 2.5, 1.9]}}],
    ...         },
    ...         "incident": {"theta_deg": [0, 60]},
    ...     }
    ... )
    <Scene gold: conductor; theta_deg 0, 60; classic slices of 90 x 360 cells; 1e7 rays; seed 1>
    """
    return _one_scene(override(_read(source), overrides))


def load_scenes(source: Source, overrides: Iterable[str | Override] = ()) -> list[Scene]:
    """Load a scene or a study.

    Parameters
    ----------
    source : path, mapping or str
        As for `load_scene`.
    overrides : iterable of str
        Changes such as ``simulation.rays=1e6``, applied before a study is expanded.

    Returns
    -------
    list of Scene
        One for each material, in the order of the study.

    Raises
    ------
    ConfigError
        As `load_scene`.

    Examples
    --------
    >>> [scene.material.name for scene in goniosim.load_scenes("study.yaml")]
    ['coat-0.1', 'coat-0.2', 'coat-0.3']
    """
    root = override(_read(source), overrides)
    return study_scenes(root) if "study" in root.value else [_one_scene(root)]


def parse_scene(
    content: str | Mapping[str, Any], source: str | None = None, overrides: Iterable[str | Override] = ()
) -> Scene:
    """Make a scene of YAML text or of a mapping with the same content.

    Parameters
    ----------
    content : str or mapping
    source : str, optional
        What error messages call it: by default ``<string>`` for text, nothing for a mapping.
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
    root = read_text(content, source or TEXT) if isinstance(content, str) else _read_mapping(content, source or "")
    return _one_scene(override(root, overrides))


def as_scene(source: Scene | Source) -> Scene:
    """The scene itself, or what `load_scene` makes of the source."""
    return source if isinstance(source, Scene) else load_scene(source)


def as_scenes(source: Iterable[Scene] | Scene | Source) -> list[Scene]:
    """The scenes of an iterable, a single one, or what `load_scenes` makes of the source.

    Raises
    ------
    ConfigError
        Also for no scenes at all, and for two of the same name.
    """
    if isinstance(source, Scene):
        return [source]
    if isinstance(source, str | os.PathLike | Mapping) or not isinstance(source, Iterable):
        return load_scenes(source)
    scenes = [as_scene(each) for each in source]
    if not scenes:
        raise ConfigError("there are no scenes to simulate")
    names = [scene.material.name.casefold() for scene in scenes]
    again = [scene.material.name for scene, name in zip(scenes, names, strict=True) if names.count(name) > 1]
    if again:
        raise ConfigError(f"several materials are named {again[0]}: give each its own name")
    return scenes


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


def load_config(path: str | os.PathLike[str], overrides: Iterable[str | Override] = ()) -> Config:
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


def _read(source: Source) -> Node:
    if isinstance(source, Mapping):
        return _read_mapping(source, "")
    # No path has a line break, and a scene in YAML has several lines.
    if isinstance(source, str) and "\n" in source:
        return read_text(source, TEXT)
    if not isinstance(source, str | os.PathLike):
        raise ConfigError(f"a scene must be a path, a mapping or YAML text [got {show(source)}]")
    return read_file(source)


def _read_mapping(content: Mapping[str, Any], source: str) -> Node:
    try:
        return from_plain(content, Origin(source, 0))
    except RecursionError:
        raise ConfigError(f"{source or 'the scene'}: is nested too deeply for a scene") from None


def _one_scene(root: Node) -> Scene:
    if "study" in root.value:
        raise config_error(
            [
                root.value["study"].problem(
                    "describes several materials, and one is needed here: "
                    "give a scene with material, or use load_scenes or simulate_study",
                    got=False,
                )
            ]
        )
    scene, problems = check(root)
    if scene is None:
        raise config_error(problems)
    return scene
