"""Which hard cases there are, by topic, and the scene of each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ..scene import Scene, load_scene
from .check import Check
from .topics import angles, chromatic, counting, indices, media, models, randomness, smoothness

SCENES = Path(__file__).resolve().parent / "scenes"


@dataclass(frozen=True)
class Case:
    """One difficulty.

    Attributes
    ----------
    name : str
        That of its scene in ``scenes``, and of the function that checks it.
    topic : str
    checks : callable
        Takes the scene and yields checks.
    """

    name: str
    topic: str
    checks: Callable[[Scene], Iterable[Check]]

    @property
    def title(self) -> str:
        """What is checked, in one sentence."""
        return (self.checks.__doc__ or "").strip().split("\n")[0]

    @property
    def path(self) -> Path:
        """The scene file."""
        return SCENES / f"{self.name}.yaml"

    @cached_property
    def why(self) -> str:
        """What breaks naive code here: the comment that begins the scene file."""
        lines = self.path.read_text(encoding="utf-8").splitlines()
        comment = []
        for line in lines:
            if not line.startswith("#"):
                break
            comment.append(line.removeprefix("#").strip())
        return " ".join(comment)

    @cached_property
    def scene(self) -> Scene:
        """The scene, loaded."""
        return load_scene(self.path)


# For each topic, the functions that check its cases. A new case is a scene file and a function in one of these.
TOPICS = {
    "Smooth and rough": smoothness.CASES,
    "Angles and cells": angles.CASES,
    "Refractive indices": indices.CASES,
    "Media and stacks": media.CASES,
    "Channels": chromatic.CASES,
    "Counting": counting.CASES,
    "Random numbers": randomness.CASES,
    "Analytic models": models.CASES,
}

CASES = {check.__name__: Case(check.__name__, topic, check) for topic, checks in TOPICS.items() for check in checks}
