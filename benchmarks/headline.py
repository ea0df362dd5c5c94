"""Time per slice for the noise of 160 million independent paths, over the 60 materials of the paper.

    python benchmarks/headline.py [--only P1 M3] [--sample 2e6]

Bati et al. 2019 trace 160 million rays per slice, in 50 s. What noise that many independent paths have, is measured
with a smaller run and scaled by the root of the number of paths. Then ``auto`` runs with as many rays as that noise
takes in every component, and that run is timed: everything from the scene to the written file, error bars, pilot and
direct reflection included. Compilation, and the trials that find the number of rays, are not. Directions that need less
than half of the rays of others are a run and a file of their own.
"""

import argparse
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from goniosim.report.cost.directions import lit_from
from goniosim.report.cost.runs import run
from goniosim.scene import load_scenes

CONFIGS = Path(__file__).resolve().parent.parent / "configs" / "paper"
CATEGORIES = ("plastics", "metals", "slabs")
RAYS = 1.6e8
# Mean and largest time of a slice that must be, in seconds.
MUST_MEAN, MUST_MAX = 0.5, 2.0
# Fewer are not worth replicates.
FIRST_RAYS, MOST_TRIALS = 1 << 17, 8
# The noise of a run is known to some per cent.
MARGIN = 1.03


@dataclass(frozen=True)
class Timed:
    """What one material took.

    Attributes
    ----------
    name : str
    seconds : ndarray, shape (M,)
        Of each slice.
    ratios : ndarray, shape (M,)
        Its noise over the one needed, of the worst component.
    analog : float
        Predicted seconds of a slice for independent paths.
    """

    name: str
    seconds: np.ndarray
    ratios: np.ndarray
    analog: float


def needed_noise(scene, sample):
    """Noise of `RAYS` independent paths by component, and the seconds of a slice with them."""
    found = run(scene, "analog", int(sample))
    scale = np.sqrt(found.rays / RAYS)
    seconds = (found.overhead + (found.seconds * RAYS / found.rays).sum()) / len(found.rays)
    return {name: noise * scale for name, noise in found.noise.items()}, seconds


def noise_ratios(found, needed):
    """Noise over the one needed, of the worst component in each direction, shape (M,); 0 where it is dark."""
    return np.max([found.noise[name] / np.where(noise > 0.0, noise, np.inf) for name, noise in needed.items()], axis=0)


def rays_for(scene, needed):
    """Rays per direction that have the noise that is needed."""
    rays = FIRST_RAYS
    for _ in range(MOST_TRIALS):
        ratios = MARGIN * noise_ratios(run(scene, "auto", rays), needed)
        if ratios.max() <= 1.0:
            break
        rays = int(rays * min(ratios.max() ** 2, 256.0)) + 1
    return np.maximum(rays * ratios**2, FIRST_RAYS).astype(int)


def groups(rays):
    """Directions, in lists, that need more than half of the rays of the first of each."""
    found = []
    for m in np.argsort(-rays, kind="stable"):
        if found and 2 * rays[m] > rays[found[-1][0]]:
            found[-1].append(int(m))
        else:
            found.append([int(m)])
    return [sorted(each) for each in found]


def part(scene, directions):
    """The scene with some of its directions."""
    return lit_from(scene, [scene.incident.theta_deg[m] for m in directions])


def measure(scene, sample, folder):
    """A `Timed` for one material."""
    needed, analog = needed_noise(scene, sample)
    rays = rays_for(scene, needed)
    seconds, ratios = np.zeros(len(rays)), np.zeros(len(rays))
    for some in groups(rays):
        these, enough = {name: noise[some] for name, noise in needed.items()}, int(rays[some].max())
        for _ in range(MOST_TRIALS):
            start = time.perf_counter()
            found = run(part(scene, some), "auto", enough)
            found.result.save(folder / "result.h5", overwrite=True)
            rest = time.perf_counter() - start - found.seconds.sum()
            seconds[some] = found.seconds + rest / len(some)
            ratios[some] = noise_ratios(found, these)
            if ratios[some].max() <= 1.0:
                break
            enough = int(enough * (MARGIN * ratios[some].max()) ** 2) + 1
    return Timed(scene.material.name, seconds, ratios, analog)


def row(name, several):
    """A line of the table for some materials."""
    seconds, ratios = (np.concatenate([getattr(one, key) for one in several]) for key in ("seconds", "ratios"))
    analog = np.mean([one.analog for one in several])
    return (
        f"{name:10}{len(several):10}{len(seconds):8}{seconds.mean():9.3f}{seconds.max():9.3f}"
        f"{seconds.sum():9.1f}{ratios.mean():9.2f}{ratios.max():7.2f}{analog:10.1f}{analog / seconds.mean():8.0f}"
    )


def main(arguments=None):
    """Measure and print; 1 if it takes longer than it must."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sample", type=float, default=2e6, help="independent paths of the smaller run")
    parser.add_argument("--only", nargs="+", metavar="LABEL", help="materials such as P1; all by default")
    options = parser.parse_args(arguments)
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for category in CATEGORIES:
            scenes = load_scenes(CONFIGS / f"{category}.yaml")
            wanted = [each for each in scenes if not options.only or each.material.name.split("-")[0] in options.only]
            for scene in wanted:
                # Compiles what this material needs.
                run(scene, "auto", FIRST_RAYS)
                one = measure(scene, options.sample, Path(folder))
                found.setdefault(category, []).append(one)
                print(f"{one.name}: {one.seconds.mean():.3f} s per slice", file=sys.stderr, flush=True)
    every = [one for several in found.values() for one in several]
    print(f"{'':10}{'':10}{'':8}{'seconds per slice':>27}{'noise ratio':>16}{'analog':>10}")
    print(f"{'category':10}{'materials':>10}{'slices':>8}{'mean':>9}{'max':>9}{'sum':>9}", end="")
    print(f"{'mean':>9}{'max':>7}{'s/slice':>10}{'gain':>8}")
    for name, several in [*found.items(), ("all", every)]:
        print(row(name, several))
    seconds = np.concatenate([one.seconds for one in every])
    reached = seconds.mean() <= MUST_MEAN and seconds.max() <= MUST_MAX
    print(f"must be: {MUST_MEAN} s on average, {MUST_MAX} s at most: {'reached' if reached else 'MISSED'}")
    return int(not reached)


if __name__ == "__main__":
    sys.exit(main())
