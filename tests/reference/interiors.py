"""A rough dielectric in the interior of a stack, met by light of one direction, and what every cell must get.

The engine integrates what the top interface reflects at once. Between index-matched smooth interfaces, which do
nothing, the same interface is sampled, from above or from below. From below, rays are put into the queue where they
would arrive; the walk is the one that all scenes take.
"""

from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from goniosim.engine.estimate import moments
from goniosim.engine.estimators.split import Split
from goniosim.engine.layout import DOWN, UP, WEIGHT, X, Z
from goniosim.engine.plan import make_plan
from goniosim.engine.splitting.layout import RATIO
from goniosim.engine.unit import BATCH, Tally, Workspace, child_key
from goniosim.engine.walk import BELOW

from .cell_integrals import integrate_cells
from .chi_square import chi_square
from .closed_forms import reflection_density, transmission_density
from .replicates import make_replicates
from .rough_plastic import rough_plastic_laws
from .scenes import dielectric, lambert, make_scene
from .score import score_of_paths, score_of_replicates
from .seeds import many_runs

ROWS, COLUMNS = 90, 36
# Relative changes by which slopes are found.
_STEP = 1e-3
_BUDGET = 1 << 22
_NARROW = 0.05
_RHO, _PLASTIC_ROWS = 0.8, 3


@dataclass(frozen=True)
class Law:
    """What a path brings to each cell of a way out: mean, second moment, and slopes by the logarithms of parameters."""

    mean: np.ndarray
    second: np.ndarray
    coin: np.ndarray
    alpha: np.ndarray

    def total(self):
        """The same of all cells together."""
        return Law(*(np.atleast_2d(each.sum()) for each in (self.mean, self.second, self.coin, self.alpha)))

    def columns(self, width):
        """The same of the first columns."""
        return Law(*(each[:, :width] for each in (self.mean, self.second, self.coin, self.alpha)))


@cache
def law_of(passes, alpha, n, theta, parametrization):
    """The law of what a rough interface of relative index ``n`` refracts, or reflects."""
    density = transmission_density if passes else reflection_density

    def integral(alpha, **options):
        made = density(alpha, n, **options)
        return integrate_cells(made, theta, ROWS, COLUMNS, parametrization, absolute=1e-10)

    mean = integral(alpha)
    coin = (integral(alpha, coin=1.0 - _STEP) - mean) / -_STEP
    width = (integral(alpha * (1.0 + _STEP)) - mean) / _STEP
    return Law(mean, integral(alpha, power=2), coin, width)


@dataclass(frozen=True)
class Meeting:
    """How light meets the interface.

    Attributes
    ----------
    alpha, n : float
        Width; index beyond over that where the light comes from.
    theta : float
        In degrees.
    from_below : bool
    parametrization : str
    last : bool
        Whether nothing is below the interface, if it is met from above: what it refracts is what leaves.
    """

    alpha: float
    n: float
    theta: float
    from_below: bool = False
    parametrization: str = "half"
    last: bool = False

    def plan(self):
        """The stack, lowered."""
        index = 1.0 / self.n if self.from_below else self.n
        below = [] if self.last else [dielectric(index)]
        layers = [dielectric(1.0), dielectric(index, self.alpha), *below]
        return make_plan(make_scene(layers, self.theta, self.parametrization, ROWS, COLUMNS))

    def laws(self):
        """Of what is reflected and of what is refracted, each on the cells that tell most of it.

        Half cells resolve reflected lobes of any width, and refracted ones at normal incidence. Refracted light is one
        number in other half slices, and narrow reflected light in classic ones: the integrals would take their time.
        """
        of = partial(law_of, alpha=self.alpha, n=self.n, theta=self.theta)
        half, classic = ({"parametrization": name} for name in ("half", "classic"))
        if self.parametrization == "classic":
            reflected = of(passes=False, **(half if self.alpha < _NARROW else classic))
            return reflected.total() if self.alpha < _NARROW else reflected, of(passes=True, **classic)
        refracted = of(passes=True, **(classic if self.theta > 0.0 else half))
        return of(passes=False, **half), refracted.total() if self.theta > 0.0 else refracted

    def ways(self):
        """Ways out of what is reflected and of what is refracted."""
        return (DOWN, UP) if self.from_below else (UP, DOWN)


def analog_energies(meeting, rays, seed):
    """Energy in the cells of the reflected and of the refracted light by the analog walk."""
    plan = meeting.plan()
    workspace, tally = Workspace(plan), Tally(plan)
    cells = workspace.cells(0, ROWS, COLUMNS, tally.histogram)

    def go_on(number):
        while not workspace.advance(0, child_key(seed, number), _BUDGET, tally.ledgers[0], cells):
            pass

    if meeting.from_below:
        for number in range(rays // BATCH):
            workspace.begin(0)
            _arrive(workspace.queues, workspace.filled, plan, 2 + BELOW)
            go_on(number)
        rays = rays // BATCH * BATCH
    else:
        workspace.begin(rays)
        go_on(0)
    return [moments(tally.histogram, plan, plan.slots[way, 0], 1)[0][0] / rays for way in meeting.ways()]


def split_energies(meeting, size, count, seed):
    """Replicates of the reflected and of the refracted light by the split walk, on the columns that tell all.

    Half of the replicates from below branch nowhere, as in a crowd.
    """
    plan = meeting.plan()
    split = Split(plan, (UP, DOWN))
    split.prepare()
    if not meeting.from_below:
        found = make_replicates(plan, split, size, seed, count)
    else:
        found = np.empty((count, plan.n_slots, plan.n_distinct, plan.rows, plan.width))
        workspace = split.workspace()
        for replicate, slices in enumerate(found):
            workspace.begin(0)
            for batch in range(size // BATCH):
                _arrive(workspace.queues, workspace.filled, plan, 2 + BELOW)
                workspace.queues[2 + BELOW, RATIO] = 1.0
                key = child_key(child_key(seed, replicate), batch)
                workspace.state[:] = 0
                while not workspace.advance(0, key, _BUDGET, crowd=-(replicate % 2)):
                    pass
            workspace._collect(size // BATCH * BATCH, slices)
    return [found[:, plan.slots[way, 0], 0] for way in meeting.ways()]


def _arrive(queues, filled, plan, queue):
    """Put a batch of rays of the plan's direction into a queue; all others are empty."""
    filled[:] = 0
    filled[queue] = BATCH
    queues[queue, X : Z + 1, :BATCH] = plan.light[0][:, None]
    queues[queue, WEIGHT : WEIGHT + plan.n_distinct, :BATCH] = 1.0


def analog_scores(meeting, rays, seed):
    """Chi-square, and scores of the coin and of the width, of the analog walk.

    Returns
    -------
    chi_square : reference.chi_square.ChiSquare
    coin, alpha : reference.score.Score
    """
    laws = meeting.laws()
    rays = rays // BATCH * BATCH
    energies = analog_energies(meeting, rays, seed)
    observed = _flat(_like(energy, law) for energy, law in zip(energies, laws, strict=True))
    mean, second, coin, alpha = _flat_laws(laws)
    return (
        chi_square(observed, mean, second, rays),
        score_of_paths(observed, mean, second, coin, rays),
        score_of_paths(observed, mean, second, alpha, rays),
    )


def split_scores(meeting, size, count, seed):
    """Scores of the coin and of the width, of the split walk."""
    laws = meeting.laws()
    energies = split_energies(meeting, size, count, seed)
    width = energies[0].shape[-1]
    laws = [law if law.mean.size == 1 else law.columns(width) for law in laws]
    # The folded half holds half of the light.
    energies = [_like(energy, law, 2.0) for energy, law in zip(energies, laws, strict=True)]
    found = np.concatenate([each.reshape(count, -1) for each in energies], axis=1)
    mean, second, coin, alpha = _flat_laws(laws)
    return score_of_replicates(found, mean, second, coin), score_of_replicates(found, mean, second, alpha)


def _like(energy, law, twins=1.0):
    """Energies in the cells of a law, or the sum of them."""
    return twins * energy.sum(axis=(-2, -1), keepdims=True) if law.mean.size == 1 else energy


def _flat(slices):
    return np.concatenate([np.ravel(each) for each in slices])


def _flat_laws(laws):
    """Means, second moments and slopes of the cells of both ways out."""
    return [_flat(getattr(law, name) for law in laws) for name in ("mean", "second", "coin", "alpha")]


def plastic_scores(n, theta, alpha, estimator, rays, runs, seed):
    """Scores of the coin and of the width, on a rough dielectric over a Lambertian base of .8, by any estimator.

    Replicates are the runs of independent paths, and the batches of all runs of other estimators.
    """
    laws = rough_plastic_laws(theta, alpha, n, _RHO, _PLASTIC_ROWS)
    layers = [dielectric(n, alpha), lambert(_RHO)]
    components, _ = many_runs(layers, theta, estimator, rays, runs, seed, rows=_PLASTIC_ROWS)
    found = components["reflection/internal"]
    # Its cells are few enough to be blocks.
    slices = found.energy[:, 0] if found.batches is None else np.concatenate(found.batches[:, :, 0])
    mean, coin, width = laws
    rows = slices.sum(axis=-1)
    return score_of_replicates(rows, mean, mean, coin), score_of_replicates(rows, mean, mean, width)
