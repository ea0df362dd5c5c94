"""Accuracy per time: the figure of merit of `auto` over independent paths, by the true standard error.

    python benchmarks/accuracy.py [--seconds 1] [--seeds 8] [--stacks plastic metal slab]

FOM = 1 / (error^2 x CPU seconds). The error is the norm of Eq. 4 (Bati et al. 2019) of the scatter of the slices over
seeds, mean over the channels: of internal paths, or for slabs of the transmission. The time is that of the process,
everything included but compilation, at about ``--seconds`` per slice; what the seven directions of a stack share is
shared out evenly. Both estimators run in turns, in one run. Of the narrow stacks no gain is demanded.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from goniosim.report.cost.runs import ESTIMATORS, run
from goniosim.scene import load_scene

STACKS = Path(__file__).resolve().parent / "stacks"
ANGLES = (30.0, 60.0, 80.0)
# Gain over independent paths that must be, and that is aimed at.
MUST = {"plastic": 250.0, "metal": 500.0, "slab": 2000.0}
AIM = 10_000.0
NARROW = ("narrow-metal", "narrow-slab")
# Fewer are not worth replicates.
FIRST_RAYS, MOST_TRIALS = 1 << 17, 12


def rays_for(scene, estimator, seconds, threads):
    """Rays per direction that take about so many CPU seconds per slice; finding them compiles what is needed."""
    rays, wanted = FIRST_RAYS, seconds * len(scene.incident.theta_deg)
    run(scene, estimator, rays, threads=threads)
    for _ in range(MOST_TRIALS):
        found = run(scene, estimator, rays, threads=threads)
        tracing = found.cpu_seconds.sum()
        left = max(wanted - found.cpu_overhead, 0.1 * wanted)
        if tracing > 0.3 * left:
            return max(FIRST_RAYS, int(rays * left / tracing))
        rays *= int(np.clip(0.5 * left / max(tracing, 1e-9), 2, 16))
    return rays


def sized(cells, directions):
    """Projected solid angles of cells in some directions, 0 of those that are not valid; shape (M, 1, R, K)."""
    return np.where(cells.valid, cells.projected_solid_angle, 0.0)[directions, None]


def squares(slices):
    """Squared deviation of each seed from their mean, shape (seeds, angles), without bias.

    Parameters
    ----------
    slices : ndarray, shape (seeds, angles, channels, rows, columns)
        BSDF values times the root of the projected solid angle.
    """
    away = ((slices - slices.mean(axis=0)) ** 2).sum(axis=(-1, -2))
    # The mean over the channels is one of norms: each channel counts with its share of it.
    root = np.sqrt(away.mean(axis=0))
    share = root.mean(axis=-1, keepdims=True) / np.maximum(root, 1e-300)
    return (away * share).mean(axis=-1) * len(slices) / (len(slices) - 1.0)


class Scatter:
    """Slices of one component over seeds, at the angles that are looked at.

    Parameters
    ----------
    theta_deg : sequence of float
        Of the scene.
    component : str
    """

    def __init__(self, theta_deg, component):
        self._component = component
        self._places = [list(theta_deg).index(angle) for angle in ANGLES]
        self._slices = []
        self._stated = []
        self._cpu = []
        self.used = []

    def add(self, found):
        """Take in a `goniosim.report.cost.runs.Run`."""
        component = found.result.components[self._component]
        size = sized(found.result.cells, self._places)
        self._slices.append(component.bsdf[self._places] * np.sqrt(size))
        self._stated.append(found.noise[self._component][self._places] ** 2)
        cpu = found.cpu_seconds + found.cpu_overhead / len(found.cpu_seconds)
        self._cpu.append(cpu[self._places])
        self.used = [found.estimators[self._component][place] for place in self._places]

    def squares(self):
        """As the function of that name, of what was added."""
        return squares(np.stack(self._slices))

    @property
    def error(self):
        """True standard error, shape (angles,)."""
        return np.sqrt(self.squares().mean(axis=0))

    @property
    def stated(self):
        """Stated one."""
        return np.sqrt(np.mean(self._stated, axis=0))

    @property
    def cpu(self):
        """CPU seconds of a slice, shape (angles,)."""
        return np.mean(self._cpu, axis=0)

    @property
    def unknown(self):
        """Relative standard error of the squared error, shape (angles,)."""
        squares = self.squares()
        return squares.std(axis=0, ddof=1) / squares.mean(axis=0) / np.sqrt(len(squares))


def measure(stack, seconds, seeds, threads):
    """A `Scatter` for each estimator on a stack."""
    scene = load_scene(STACKS / f"{stack}.yaml")
    component = "transmission" if scene.material.transmits else "reflection/internal"
    rays = {each: rays_for(scene, each, seconds, threads) for each in ESTIMATORS}
    found = {each: Scatter(scene.incident.theta_deg, component) for each in ESTIMATORS}
    for seed in range(1, seeds + 1):
        for each in ESTIMATORS:
            found[each].add(run(scene, each, rays[each], seed=seed, threads=threads))
    return found


def gains(found):
    """FOM of ``auto`` over that of ``analog`` with its relative standard error, each of shape (angles,)."""
    auto, analog = (found[each] for each in ESTIMATORS)
    gain = (analog.error**2 * analog.cpu) / (auto.error**2 * auto.cpu)
    return gain, np.hypot(auto.unknown, analog.unknown)


def verdict(stack, gain):
    """What a gain is, held against what it must be."""
    if stack not in MUST:
        return ""
    return "aim" if gain >= AIM else "reached" if gain >= MUST[stack] else "MISSED"


def main(arguments=None):
    """Measure and print; 1 if a gain misses what it must be."""
    known = sorted(path.stem for path in STACKS.glob("*.yaml"))
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=1.0, help="CPU seconds per slice")
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--stacks", nargs="+", choices=known, default=[*MUST, *NARROW])
    options = parser.parse_args(arguments)
    print(f"{'stack':14}{'theta':>6}{'by':>12}{'error':>10}{'stated':>9}{'CPU s':>8}", end="")
    print(f"{'analog':>10}{'stated':>9}{'CPU s':>8}{'FOM ratio':>12}{'±':>6}{'must':>7}")
    missed = False
    for stack in options.stacks:
        found = measure(stack, options.seconds, options.seeds, options.threads)
        auto, analog = (found[each] for each in ESTIMATORS)
        for i, (gain, unknown) in enumerate(zip(*gains(found), strict=True)):
            told = verdict(stack, gain)
            missed |= told == "MISSED"
            print(
                f"{stack:14}{ANGLES[i]:6.0f}{auto.used[i]:>12}"
                + "".join(
                    f"{each.error[i]:{width}.2e}{each.stated[i] / each.error[i]:9.2f}{each.cpu[i]:8.2f}"
                    for each, width in ((auto, 10), (analog, 10))
                )
                + f"{gain:12.4g}{100.0 * unknown:5.0f}%{MUST.get(stack, 0.0):7.0f}  {told}",
                flush=True,
            )
    print("error: true, in sr^-1/2; stated: over the true one; ±: standard error of the ratio, from the seeds")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
