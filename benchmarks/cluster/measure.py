"""Overheads of shards, each by running the command or the function that users run."""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from goniosim.cluster import Division, ShardPlan
from goniosim.engine.packing import pack, unpack
from goniosim.scene import load_scene
from goniosim.store import read_portion, write_portion

STACKS = Path(__file__).resolve().parents[1] / "stacks"
MATERIALS = ("plastic", "metal", "slab")
COMMAND = Path(sys.executable).parent / "goniosim"
TINY = """\
material:
  name: tiny
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.1}
    - interface: {type: lambert, rho: 0.5}
incident: {theta_deg: [30]}
slice: {rows: 2, columns: 4}
simulation: {rays: 100}
"""


@dataclass(frozen=True)
class Cut:
    """A study in n shards.

    Attributes
    ----------
    shards : int
    traced : float
        Seconds of all shards, one after the other.
    merged : float
        Seconds of the merge.
    files, size : int
        Portion files, and bytes of them.
    """

    shards: int
    traced: float
    merged: float
    files: int
    size: int


@dataclass(frozen=True)
class Measured:
    """What was measured.

    Attributes
    ----------
    cold, warm : float
        Seconds of a shard with next to no work: with an empty cache of kernels, and with a full one.
    checkpoint : float
        Seconds of a checkpoint.
    checkpoint_size : int
        Bytes of its file.
    cuts : list of Cut
    plain : float
        Seconds of the study in one go.
    """

    cold: float
    warm: float
    checkpoint: float
    checkpoint_size: int
    cuts: list
    plain: float

    @property
    def merge_fixed(self):
        """Seconds of a merge for each material, whatever the number of portions."""
        return self._merge_line()[0]

    @property
    def merge_rate(self):
        """Seconds of a merge for each gigabyte of portions."""
        return self._merge_line()[1]

    def _merge_line(self):
        """The line through the first cut and the last."""
        first, last = self.cuts[0], self.cuts[-1]
        rate = (last.merged - first.merged) / (last.size - first.size)
        return (first.merged - rate * first.size) / len(MATERIALS), 1e9 * rate


def measure(rays, counts, say):
    """Measure everything, on an otherwise idle machine.

    Parameters
    ----------
    rays : int
        Of each direction of the three materials.
    counts : sequence of int
        Numbers of shards, rising.
    say : callable
        Called with a line on what is done.

    Returns
    -------
    Measured
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        cold, warm = _start_up(folder)
        say(f"start-up: {cold:.1f} s cold, {warm:.2f} s warm")
        study = _study(folder, rays)
        _run("simulate", study, "--rays", "131072", "-q", "-o", folder / "warm")
        plain = _run("simulate", study, "-q", "-o", folder / "plain")
        say(f"in one go: {plain:.1f} s")
        cuts = []
        for count in counts:
            cuts.append(_cut(folder, study, count))
            say(str(cuts[-1]))
        checkpoint, size = _checkpoint(folder, counts[0])
        say(f"checkpoint: {checkpoint:.2f} s, {size / 1e6:.0f} MB")
    return Measured(cold, warm, checkpoint, size, cuts, plain)


def _start_up(folder):
    scene = folder / "tiny.yaml"
    scene.write_text(TINY, encoding="utf-8")
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache")}
    times = [
        _run("simulate", scene, "--shard", "1/1", "-q", "-o", folder / f"tiny-{i}", environment=environment)
        for i in range(4)
    ]
    return times[0], statistics.median(times[1:])


def _study(folder, rays):
    scenes = [load_scene(STACKS / f"{name}.yaml", [f"simulation.rays={rays}"]) for name in MATERIALS]
    parts = [scene.to_yaml().splitlines() for scene in scenes]
    shared = parts[0][next(i for i, line in enumerate(parts[0]) if line.startswith("incident")) :]
    lines = ["study:", "  name: shards", "  materials:"]
    for part in parts:
        body = part[1 : next(i for i, line in enumerate(part) if line.startswith("incident"))]
        lines += [f"    {'- ' if i == 0 else '  '}{line[2:]}" for i, line in enumerate(body)]
    path = folder / "study.yaml"
    path.write_text("\n".join([*lines, *shared]) + "\n", encoding="utf-8")
    return path


def _cut(folder, study, count):
    shards = folder / f"shards-{count}"
    traced = sum(_run("simulate", study, "--shard", f"{k}/{count}", "-q", "-o", shards) for k in range(1, count + 1))
    merged = _run("merge", shards, "-q", "-o", folder / f"merged-{count}")
    portions = list(shards.glob("*.h5"))
    return Cut(count, traced, merged, len(portions), sum(path.stat().st_size for path in portions))


def _checkpoint(folder, count):
    """Of the largest portion: packing its sums, and writing them."""
    shards = folder / f"shards-{count}"
    tasks = Division(ShardPlan.read(shards)).all_tasks()
    path = max((task.path(shards) for task in tasks), key=lambda each: each.stat().st_size)
    portion, state = read_portion(path)
    tree = unpack(state)
    began = time.perf_counter()
    write_portion(portion, pack(tree), folder / "checkpoint.h5")
    return time.perf_counter() - began, path.stat().st_size


def _run(*arguments, environment=None):
    began = time.perf_counter()
    subprocess.run([COMMAND, *map(str, arguments)], check=True, env=environment)
    return time.perf_counter() - began
