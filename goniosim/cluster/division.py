"""Which shard traces what: all work on a line, cut into equal lengths."""

import itertools
from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from goniosim.cluster.plan_file import ShardPlan
from goniosim.engine import piece_rays
from goniosim.scene import Scene
from goniosim.writing import StrPath


@dataclass(frozen=True)
class Task:
    """What one shard has of one material.

    Attributes
    ----------
    shard, shards : int
    scene : goniosim.scene.Scene
    first, end : int or None
        Its pieces: from ``first`` to before ``end``; None for all of a scene that stops at a target, whose work
        nobody knows ahead.
    """

    shard: int
    shards: int
    scene: Scene
    first: int | None = None
    end: int | None = None

    @property
    def is_result(self) -> bool:
        """Whether its file is a result as `goniosim simulate` writes it, and not a portion."""
        return self.first is None

    @property
    def name(self) -> str:
        """Of its file."""
        material = self.scene.material.name
        return f"{material}.h5" if self.is_result else f"{material}.shard-{self.shard:05d}-of-{self.shards:05d}.h5"

    def path(self, folder: StrPath) -> Path:
        """Of its file in a folder."""
        return Path(folder) / self.name


class Division:
    """The tasks of a plan.

    Parameters
    ----------
    plan : ShardPlan
    """

    def __init__(self, plan: ShardPlan) -> None:
        self._plan = plan
        self._known: dict[int, list[float]] = {}

    @cached_property
    def _starts(self) -> list[float]:
        """Where each scene begins on the line, and the end of the last."""
        return [0.0, *itertools.accumulate(self._plan.weights)]

    def tasks(self, shard: int) -> list[Task]:
        """Those of a shard, from 1 on; none if there are more shards than pieces of work."""
        low, high = (self._starts[-1] * k / self._plan.shards for k in (shard - 1, shard))
        found = []
        for number in range(bisect_right(self._starts, low) - 1, len(self._plan.scenes)):
            start, stop = self._starts[number : number + 2]
            if start >= high:
                break
            found += self._of_scene(shard, number, (low - start) / (stop - start), (high - start) / (stop - start))
        return found

    def all_tasks(self) -> list[Task]:
        """Those of all shards, in their order."""
        return [task for shard in range(1, self._plan.shards + 1) for task in self.tasks(shard)]

    def rays(self, shard: int) -> int | None:
        """Light paths of a shard; None if a target decides."""
        tasks = self.tasks(shard)
        if any(task.is_result for task in tasks):
            return None
        return sum(sum(piece_rays(task.scene)[task.first : task.end]) for task in tasks)

    def _of_scene(self, shard: int, number: int, low: float, high: float) -> list[Task]:
        """Whatever has its middle between two shares of a scene."""
        scene = self._plan.scenes[number]
        if scene.simulation.target is not None:
            return [Task(shard, self._plan.shards, scene)] if low <= 0.5 < high else []
        middles = self._middles(number)
        first, end = bisect_left(middles, low), bisect_left(middles, high)
        return [Task(shard, self._plan.shards, scene, first, end)] if first < end else []

    def _middles(self, number: int) -> list[float]:
        if number not in self._known:
            rays = piece_rays(self._plan.scenes[number])
            ends = list(itertools.accumulate(rays))
            self._known[number] = [(end - own / 2) / ends[-1] for own, end in zip(rays, ends, strict=True)]
        return self._known[number]
