"""The file `plan.json` of a folder of shards: what is simulated, and into how many shards it is cut."""

import itertools
import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from goniosim.errors import ConfigError, ForeignFileError, NewerSchemaError, OutputError, UnusableResultError
from goniosim.provenance import version_of
from goniosim.scene import Scene, differences, parse_scene
from goniosim.writing import StrPath, make_folder, printable, write_text

NAME = "plan.json"
FILETYPE, SCHEMA_VERSION = "goniosim-shards", 1
MOST_SHARDS = 1_000_000


@dataclass(frozen=True)
class ShardPlan:
    """A study in shards.

    Attributes
    ----------
    shards : int
    study : str or None
        Name of the study, None for a single scene.
    scenes : tuple of goniosim.scene.Scene
        Without threads, which are each machine's own.
    weights : tuple of float
        Time that each scene takes, relative to the others.
    goniosim_version : str
    """

    shards: int
    study: str | None
    scenes: tuple[Scene, ...]
    weights: tuple[float, ...]
    goniosim_version: str

    def __post_init__(self) -> None:
        ends = [0.0, *itertools.accumulate(self.weights)]
        # What is lost beside the others would have no place of its own.
        if not all(before < end < math.inf for before, end in itertools.pairwise(ends)):
            raise ConfigError("weights must be above 0, and none lost in the rounding of their sum")

    @property
    def has_targets(self) -> bool:
        """Whether nobody knows all of its light paths ahead."""
        return any(scene.simulation.target is not None for scene in self.scenes)

    @classmethod
    def make(
        cls, scenes: Iterable[Scene], study: str | None, shards: int, weights: Sequence[float] | None = None
    ) -> Self:
        """A plan of this version of goniosim.

        Parameters
        ----------
        scenes : iterable of goniosim.scene.Scene
        study : str or None
        shards : int
        weights : sequence of float, optional
            By default the light paths of each scene, or its directions where a target decides.

        Raises
        ------
        ConfigError
            If there are too many shards, or none.
        """
        if not 1 <= shards <= MOST_SHARDS:
            raise ConfigError(f"shards must be a whole number from 1 to {MOST_SHARDS} [got {shards}]")
        scenes = tuple(_without_threads(scene) for scene in scenes)
        if weights is None:
            weights = [len(scene.incident.theta_deg) * (scene.simulation.rays or 1) for scene in scenes]
        return cls(shards, study, scenes, tuple(map(float, weights)), version_of("goniosim"))

    def write(self, folder: StrPath) -> None:
        """Write it into a folder, which is made.

        Raises
        ------
        OutputError
            If it cannot be written.
        """
        make_folder(folder)
        content = {
            "filetype": FILETYPE,
            "schema_version": SCHEMA_VERSION,
            "goniosim_version": self.goniosim_version,
            "study": self.study,
            "shards": self.shards,
            "weights": self.weights,
            "scenes": [scene.to_yaml() for scene in self.scenes],
        }
        write_text(Path(folder) / NAME, json.dumps(content, indent=1) + "\n")

    @classmethod
    def find(cls, folder: StrPath) -> Self | None:
        """Read that of a folder, if it has one; errors as of `read`."""
        return cls.read(folder) if (Path(folder) / NAME).exists() else None

    @classmethod
    def read(cls, folder: StrPath) -> Self:
        """Read that of a folder.

        Raises
        ------
        ForeignFileError
            If there is none, or it is something else.
        NewerSchemaError
            If only a newer goniosim can read it.
        """
        path = Path(folder) / NAME
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise ForeignFileError(
                f"{folder}: is no folder of shards: {NAME} is missing; name the folder that `simulate --shard` "
                "or `goniosim plan` wrote to"
            ) from None
        except (OSError, ValueError, RecursionError) as error:
            raise ForeignFileError(f"{path}: cannot be read: {error}; write it anew with `goniosim plan`") from error
        if not isinstance(content, dict) or content.get("filetype") != FILETYPE:
            raise ForeignFileError(f"{path}: is not a plan of shards; write it anew with `goniosim plan`")
        version = content.get("schema_version")
        if isinstance(version, int | float) and version > SCHEMA_VERSION:
            raise NewerSchemaError(f"{path}: is of a newer goniosim; update goniosim")
        try:
            return cls._parsed(content)
        except (ConfigError, ValueError, TypeError, LookupError, ArithmeticError) as error:
            why = printable(" ".join(str(error).split()), 200)
            raise ForeignFileError(f"{path}: is not a plan of shards: {why}; write it anew") from error

    @classmethod
    def _parsed(cls, content: dict[str, Any]) -> Self:
        names = ("study", "shards", "scenes", "weights", "goniosim_version", "schema_version")
        if missing := [name for name in names if name not in content]:
            raise ValueError(f"it lacks {missing[0]}")
        study, shards, texts = content["study"], content["shards"], content["scenes"]
        if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
            raise ValueError("scenes must be a list of texts")
        if not isinstance(content["weights"], list) or not isinstance(study, str | None):
            raise ValueError("its entries are of other kinds")
        if not isinstance(shards, int) or not 1 <= shards <= MOST_SHARDS:
            raise ValueError(f"shards must be a whole number from 1 to {MOST_SHARDS}")
        weights = tuple(float(weight) for weight in content["weights"])
        if not len(weights) == len(texts) > 0:
            raise ValueError(f"{len(weights)} weights for {len(texts)} scenes")
        scenes = tuple(_without_threads(parse_scene(text)) for text in texts)
        if len({scene.material.name.casefold() for scene in scenes}) < len(scenes):
            raise ValueError("two of its scenes have the same name")
        return cls(shards, study, scenes, weights, str(content["goniosim_version"]))

    def require_version(self, folder: StrPath) -> None:
        """Raise an UnusableResultError if another version of goniosim made it: its numbers would differ."""
        here = version_of("goniosim")
        if self.goniosim_version != here:
            raise UnusableResultError(
                f"{folder}: its shards are of goniosim {self.goniosim_version}, and this is {here}; "
                "use that one for the rest, or begin in an empty folder"
            )

    def require_same(self, other: Self, folder: StrPath) -> None:
        """Raise an OutputError if another plan is to share a folder with this one, and differs."""
        details = []
        if other.shards != self.shards:
            details.append(f"it is cut into {self.shards} shards, not into {other.shards}")
        mine, theirs = ({scene.material.name: scene for scene in plan.scenes} for plan in (self, other))
        details += [f"{name}: only there" for name in mine if name not in theirs]
        details += [f"{name}: not there" for name in theirs if name not in mine]
        for name in mine.keys() & theirs.keys():
            if mine[name] != theirs[name]:
                found = differences(mine[name], theirs[name]) or [
                    f"{mine[name].simulation.asked} there, not {theirs[name].simulation.asked}"
                ]
                details += [f"{name}: {line}" for line in found]
        if details or list(mine) != list(theirs):
            raise OutputError(
                f"{folder}: holds shards of something else; choose another folder with -o, or remove this one",
                details[:20] or ["the materials stand in another order"],
            )


def _without_threads(scene: Scene) -> Scene:
    return scene.model_copy(update={"simulation": scene.simulation.model_copy(update={"threads": None})})


def plan_of(folder: StrPath, asked: ShardPlan) -> ShardPlan:
    """The plan of a folder: what stands there, or else what is asked for, which is written.

    Parameters
    ----------
    folder : path-like
    asked : ShardPlan
        Its weights count only where no plan stands.

    Raises
    ------
    OutputError
        If another one stands there, or other files do, or it cannot be written.
    UnusableResultError
        If that there is of another version of goniosim.
    """
    there = ShardPlan.find(folder)
    if there is None:
        if results := sorted(path.name for path in Path(folder).glob("*.h5") if ".shard-" not in path.name):
            raise OutputError(f"{folder}: holds other files, such as {results[0]}: give shards a folder of their own")
        # Whoever comes at the same time writes the same.
        asked.write(folder)
        return asked
    there.require_same(asked, folder)
    there.require_version(folder)
    return there
