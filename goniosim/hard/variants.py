"""Scenes that differ from one of the catalogue in a few places."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from ..scene import Scene, parse_scene
from .check import Check


def varied(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """Return the scene with other values.

    Parameters
    ----------
    scene : Scene
    changes : mapping of str to object
        New values by their places, such as ``material.layers.0.interface.alpha`` or ``incident.theta_deg``; places
        that are not there yet are made.

    Returns
    -------
    Scene

    Raises
    ------
    goniosim.errors.ConfigError
        The new scene is not legal.
    """
    content = scene.model_dump(mode="json", exclude_none=True)
    for place, value in changes.items():
        *path, last = (int(key) if key.isdigit() else key for key in place.split("."))
        where: Any = content
        for key in path:
            where = where[key]
        where[last] = value
    return parse_scene(content)


def labelled(label: str, checks: Iterable[Check]) -> Iterator[Check]:
    """Say of each check which variant it is of."""
    for check in checks:
        yield replace(check, checked=f"{label}: {check.checked}")
