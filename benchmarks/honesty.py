"""How honest error bars are: the scatter of slices over seeds, held against what each run states of it.

    python -m benchmarks.honesty [--seeds 40] [--stacks metal slab] [--paths 131072 524288] [--threads 1] [--json]

One row for each stack, component, estimator, incident angle and number of paths. ``ratio`` is the true over the stated
variance, both as the norm of Eq. 4 (Bati et al. 2019). The other columns are shares of |z| < 2: of cells that hold
more than 3 % of the peak, and of blocks of 6 x 12 cells by their share of the energy. z is the deviation from the mean
of the other seeds, over the root of the stated variance and of that of the mean. Cells and blocks count that the rule
of `goniosim.effective` finds certain by the means over all seeds: a choice by each seed's own marks would be one by its
deviation. ``unsure`` is the share of marks among the bright cells. What replicates state follows Student's t with 31
degrees of freedom, and what independent paths state is nearly normal.

A row fails if the ratio is off by more than 5 %, or a share by more than 1.5 points (3 points at 1e-5), and by more
than four of its standard errors, as the seeds tell them (of few numbers at least their own): a handful of seeds tells
little of those. Over the 600 verdicts of the whole table the false-alarm rate is then about 4 %. Where one random
number moves all cells of a slice, few seeds have any outside of their bars: a share above the expected one has the
standard error that so many independent numbers leave as the ratio has. What holds below 1e-5 is told without a verdict.
"""

import argparse
import json
import math
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from benchmarks.accuracy import ANGLES, STACKS, sized, squares
from goniosim.effective import uncertain
from goniosim.report.cost.directions import lit_from
from goniosim.report.cost.runs import run, sampled
from goniosim.scene import load_scene
from goniosim.sums import BATCHES, block_sums

CASES = (
    "plastic",
    "metal",
    "slab",
    "slab-05-001",
    "metal-05-001",
    "narrow-metal",
    "metal-001-2",
    "metal-05-2",
    "three",
)
# ``auto`` takes independent paths where there are fewer than 131072.
PATHS = {"auto": (131_072, 524_288), "analog": (40_000, 120_000)}
BRIGHT = 0.03
# Limits of the share of a block in the energy of its channel.
GROUPS = {
    "1e-3": (1e-3, math.inf),
    "1e-4": (1e-4, math.inf),
    "1e-5": (1e-5, math.inf),
    "1e-6": (1e-6, 1e-5),
}
# How far a share may be off; nothing is demanded of the others.
BARS = {"bright": 0.015, "1e-3": 0.015, "1e-4": 0.015, "1e-5": 0.03}
RATIO_BAR = 0.05
SIGMAS = 4.0


def within_two(freedom):
    """Probability that |t| < 2, for an odd number of degrees of freedom of Student's t, or for infinitely many."""
    if math.isinf(freedom):
        return math.erf(math.sqrt(2.0))
    angle = math.atan(2.0 / math.sqrt(freedom))
    term, total = math.cos(angle), 0.0
    for k in range(1, int(freedom) // 2 + 1):
        total += term
        term *= math.cos(angle) ** 2 * 2 * k / (2 * k + 1)
    return 2.0 / math.pi * (angle + math.sin(angle) * total)


def told(values):
    """Mean of what each seed tells, and its standard error."""
    return float(np.mean(values)), float(np.std(values, ddof=1) / math.sqrt(len(values)))


def share_told(z, counts, expected):
    """Share of |z| < 2 where it counts, and its standard error: by the seeds, and at least that of single numbers.

    Parameters
    ----------
    z : iterable of ndarray
        Of each seed.
    counts : ndarray of bool
    expected : float
        The share that it should be.

    Returns
    -------
    share, stderr : float
        NaN if nothing counts.
    """
    if not counts.any():
        return math.nan, math.nan
    shares = [float((np.abs(each[counts]) < 2.0).mean()) for each in z]
    share, error = told(shares)
    return share, max(error, math.sqrt(expected * (1.0 - expected) / (counts.sum() * len(shares))))


def deviations(value, variance, mean, variance_sum, seeds):
    """Deviation of a seed from the mean of the others, in standard errors of the difference; NaN where none is stated.

    Parameters
    ----------
    value, variance : ndarray
        Of this seed.
    mean, variance_sum : ndarray
        Mean of the values, and sum of the variances, of all seeds.
    seeds : int
    """
    others = seeds - 1
    away = (value - mean) * (seeds / others)
    error2 = variance + (variance_sum - variance) / others**2
    return np.divide(away, np.sqrt(error2), out=np.full(away.shape, np.nan), where=error2 > 0.0)


@dataclass(frozen=True)
class Row:
    """How honest the error bars of one slice are.

    Attributes
    ----------
    stack, component, estimator : str
    theta_deg : float
    paths : int
    ratio : (float, float)
        True over stated variance, and its standard error.
    shares : dict of str to (float, float)
        Share of |z| < 2 in each group, and its standard error; NaN where there is nothing.
    expected : float
        The share by Student's t.
    unsure : float
        Share of the bright cells that are marked uncertain.
    """

    stack: str
    component: str
    estimator: str
    theta_deg: float
    paths: int
    ratio: tuple
    shares: dict
    expected: float
    unsure: float

    @property
    def faults(self):
        """Columns that are off by more than they may, and by more than the seeds leave open."""
        value, error = self.ratio
        # That of a ratio of one: what the seeds tell of their scatter grows with it.
        error /= value
        found = [] if abs(value - 1.0) <= max(RATIO_BAR, SIGMAS * error) else ["ratio"]
        # The mean of 2 / error^2 squares of normal numbers is known like this ratio.
        of_few = error * math.sqrt(0.5 * self.expected * (1.0 - self.expected))
        for name, bar in BARS.items():
            share, error = self.shares[name]
            if share > self.expected:
                error = max(error, of_few)
            if abs(share - self.expected) > max(bar, SIGMAS * error):
                found.append(name)
        return found


class Slice:
    """One component in one direction, over seeds; slices lie in a file, sums of blocks in memory.

    Parameters
    ----------
    seeds : int
    shape : tuple of int
        Of a slice: channels, rows, columns.
    folder : Path
    """

    def __init__(self, seeds, shape, folder):
        with tempfile.NamedTemporaryFile(dir=folder, delete=False) as place:
            self._cells = np.memmap(place.name, dtype=float, mode="w+", shape=(seeds, 3, *shape))
        self._blocks = []
        self._n = self._number = 0
        self.estimator = ""

    def add(self, result, name, direction):
        """Take in a result."""
        component = result.components[name]
        self.estimator = component.estimator[direction]
        energy, stderr = component.energy[direction], component.stderr[direction]
        self._cells[self._n] = energy, stderr**2, component.uncertain[direction]
        self._n += 1
        if self.estimator == "analog":
            self._number = int(result.rays[direction])
            sums = block_sums(energy)
            shared = (sums**2 - block_sums(energy**2)) / max(self._number - 1, 1)
            variance = np.maximum(block_sums(stderr**2) - shared, 0.0)
        else:
            batches = component.batches[direction]
            self._number = len(batches)
            sums, variance = batches.mean(axis=0), batches.var(axis=0, ddof=1) / self._number
        self._blocks.append((sums, variance))

    def row(self, stack, component, theta_deg, paths, cells, direction):
        """A `Row` of what the seeds tell."""
        seeds = self._n
        size = sized(cells, [direction])[0]
        scale = np.divide(1.0, np.sqrt(size), out=np.zeros(size.shape), where=size > 0.0)
        mean, variance = (sum(one[part] for one in self._cells) for part in (0, 1))
        mean = mean / seeds
        true = squares((self._cells[:, None, 0] - mean) * scale)[:, 0]
        stated = np.array([np.sqrt((one[1] * scale**2).sum(axis=(-1, -2))).mean() ** 2 for one in self._cells])
        (top, top_error), (bottom, bottom_error) = told(true), told(stated)
        ratio = top / bottom
        peak = np.max(np.divide(mean, size, out=np.zeros(mean.shape), where=size > 0.0), axis=(-1, -2), keepdims=True)
        bright = (mean > BRIGHT * peak * size) & (size > 0.0)
        expected = within_two(math.inf if self.estimator == "analog" else BATCHES - 1)
        counts = bright & ~uncertain(mean, np.sqrt(variance / seeds), self._number)
        z = (deviations(one[0], one[1], mean, variance, seeds) for one in self._cells)
        shares = {"bright": share_told(z, counts, expected), **self._of_blocks(expected)}
        unsure = np.mean([one[2][bright].mean() for one in self._cells])
        return Row(
            stack=stack,
            component=component,
            estimator=self.estimator,
            theta_deg=float(theta_deg),
            paths=int(paths),
            ratio=(ratio, ratio * math.hypot(top_error / top, bottom_error / bottom)),
            shares=shares,
            expected=expected,
            unsure=float(unsure),
        )

    def _of_blocks(self, expected):
        sums, variances = (np.array([one[part] for one in self._blocks]) for part in range(2))
        mean, variance = sums.mean(axis=0), variances.sum(axis=0)
        share = mean / np.maximum(mean.sum(axis=(-1, -2), keepdims=True), 1e-300)
        certain = ~uncertain(mean, np.sqrt(variance / len(sums)), self._number)
        z = [deviations(*each, mean, variance, len(sums)) for each in zip(sums, variances, strict=True)]
        return {
            name: share_told(z, certain & (share >= low) & (share < high), expected)
            for name, (low, high) in GROUPS.items()
        }


def rows_of(stack, estimator, paths, seeds, threads):
    """Rows of a stack by ``auto`` or ``analog``."""
    scene = lit_from(load_scene(STACKS / f"{stack}.yaml"), ANGLES)
    with tempfile.TemporaryDirectory() as folder:
        slices = {}
        for seed in range(1, seeds + 1):
            result = run(scene, estimator, paths, seed=seed, threads=threads).result
            for name, component in sampled(result).items():
                for m in range(len(ANGLES)):
                    if (name, m) not in slices:
                        slices[name, m] = Slice(seeds, component.energy.shape[1:], Path(folder))
                    slices[name, m].add(result, name, m)
        for (name, m), one in slices.items():
            yield one.row(stack, name, ANGLES[m], result.rays[m], result.cells, m)


def line(row):
    """A row of the table."""
    shares = "".join(f"{100.0 * share:8.1f} ±{100.0 * error:4.1f}" for share, error in row.shares.values())
    verdict = "OFF: " + ", ".join(row.faults) if row.faults else "honest"
    return (
        f"{row.stack:13}{row.component:21}{row.estimator:11}{row.theta_deg:5.0f}{row.paths:9d}{row.ratio[0]:7.3f} "
        f"±{row.ratio[1]:6.3f}{shares}{100.0 * row.expected:7.1f}{100.0 * row.unsure:8.1f}  {verdict}"
    )


def main(arguments=None):
    """Measure and print; 1 if a row is off."""
    known = sorted(path.stem for path in STACKS.glob("*.yaml"))
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=40, help="3 at the least")
    parser.add_argument("--stacks", nargs="+", choices=known, default=CASES)
    parser.add_argument("--paths", nargs="+", type=int, help="of auto alone, per direction")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--json", action="store_true", help="the rows as JSON, at the end")
    options = parser.parse_args(arguments)
    if options.seeds < 3:
        parser.error("--seeds: fewer than 3 tell nothing")
    asked = {"auto": options.paths} if options.paths else PATHS
    if not options.json:
        print(f"{'stack':13}{'component':21}{'estimator':11}{'theta':>5}{'paths':>9}{'ratio':>7}{'':8}", end="")
        print("".join(f"{name:>8}{'':6}" for name in ("bright", *GROUPS)) + f"{'t':>7}{'unsure':>8}")
    found = []
    for stack in options.stacks:
        for estimator, several in asked.items():
            for paths in several:
                for row in rows_of(stack, estimator, paths, options.seeds, options.threads):
                    found.append(row)
                    if not options.json:
                        print(line(row), flush=True)
    if options.json:
        # What nothing is known of is null.
        answer = [{**asdict(row), "faults": row.faults} for row in found]
        print(json.dumps(json.loads(json.dumps(answer), parse_constant=lambda name: None), indent=2))
    return int(any(row.faults for row in found))


if __name__ == "__main__":
    sys.exit(main())
