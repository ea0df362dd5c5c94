"""What few hits say about a component, and what no hit leaves open.

Hits are counted in each channel: by their effective number, which one path that carries nearly all makes 1.

A cell that no path hit states the energy 0 and no error bar. That is no measurement of zero: if a
hit brings the energy q, the hits of a cell of energy E are Poissonian with mean E / q, and there is
none at all with probability exp(-E / q), which falls below 5 % only at E = 3 q, the rule of three.
The same holds for a whole component in one direction. q is the sum of the squares of what the hits
bring over the sum of it, and 1 / rays where there is none: a path brings at most its whole flux.

The squared error of a true model, its noise taken out, has the mean 0 however few hits there are, and
the variance sum 2 w^2 s^4 with s^2 = E q / w^2 the variance of a cell's BSDF. What fails with few hits
is to estimate that variance from them: it needs hits in a cell and in its mirror image. But a true
model knows it. So, in cells where a true model expects few hits,

    variance = max( from the hits,  sum 2 w^2 (c E q / w^2)^2 ),   E: energy of the model,
    c = min(1, (n + 2 sqrt(n) + 3) q / sum E),                     n: hits in all these cells.

c keeps a model that claims more energy there than can have gone unseen from excusing itself by it:
n + 2 sqrt(n) + 3 is an upper limit of the mean of a Poissonian that yielded n, 3 for n = 0.

Where a component has no hit at all in a direction there is no noise either, and the question is just
whether so much can have gone unseen: as long as sum E <= 3 / rays the model may be right, and above
it is wrong by at least (1 - c) of its size, c = 3 / (rays sum E). So c (2 - c) of the squared error,
all of it up to sum E = 3 / rays, is explained by what went unseen.

Estimators whose paths share events or deposits have no hits. For them the effective number of a cell is (E / s)^2, and
a true model expects few only where the result itself calls a cell or its mirror image uncertain: elsewhere dim cells
are known as well as bright ones.
"""

from dataclasses import dataclass

import numpy as np

from ..effective import effective_count
from ..result import Component
from ..sums import noise_of

RULE_OF_THREE = 3.0
# A true model that expects fewer hits than this in a cell and its mirror image together expects few.
FEW = 10.0


@dataclass(frozen=True)
class Counts:
    """How a reference was counted.

    Attributes
    ----------
    sampled : goniosim.result.Component
        The part of the reference that is sampled.
    rays : ndarray, shape (M,)
    integrated : ndarray, shape (M, C, R, K)
        The part of the reference that is integrated and not sampled, in 1/sr.
    """

    sampled: Component
    rays: np.ndarray
    integrated: np.ndarray


def count(result, component):
    """The `Counts` of all components of a result whose name begins with ``component``; None if integrated."""
    parts = [part for name, part in result.components.items() if name.startswith(component)]
    sampled = [part for part in parts if part.sampled]
    if not sampled:
        return None
    none = np.zeros_like(parts[0].bsdf)
    # Reflection has a direct part, which is integrated, and one other; transmission is one.
    return Counts(sampled[0], result.rays, sum((part.bsdf for part in parts if not part.sampled), none))


class Expected:
    """What a true model expects of the counts in one direction.

    Parameters
    ----------
    model, reference, stderr : ndarray, shape (C, R, K)
        BSDF in 1/sr.
    size : ndarray, shape (R, K)
        Projected solid angles in sr, 0 in cells that do not count.
    counts : Counts
    direction : int

    Attributes
    ----------
    hit : ndarray of bool, shape (C, R, K)
        Cells that something arrived in.
    effective : ndarray, shape (C, R, K)
        Effective number of hits.
    noise : goniosim.sums.Paths or goniosim.sums.Batches or None
        How the noise of the cells hangs together.
    unseen : ndarray of bool, shape (C,)
        Channels in which the component has no hit at all.
    per_hit : ndarray, shape (C,)
        Energy q of a hit.
    n : ndarray, shape (C, R, K)
        Hits in each cell.
    variance : ndarray, shape (C, R, K)
        Of the BSDF of each cell, in 1/sr^2; 0 where the reference knows better.
    few : ndarray of bool, shape (C, R, K)
        Cells with few hits.
    """

    def __init__(self, model, reference, stderr, size, counts, direction):
        self._size = size
        sampled, rays = counts.sampled, int(counts.rays[direction])
        integrated = counts.integrated[direction]
        self.noise = noise_of(sampled, direction, rays)
        independent = sampled.estimator[direction] == "analog"
        energy = np.where(size > 0.0, sampled.energy[direction], 0.0)
        # Without independent paths there is no limit to the effective number.
        n = rays if independent else np.inf
        self.effective = _effective(energy, sampled.stderr[direction], n)
        # A path may arrive without any energy left in a channel: that is seen, and nothing.
        hit = energy > 0.0 if sampled.hits is None else sampled.hits[direction] > 0
        self.hit = np.broadcast_to(hit & (size > 0.0), energy.shape)
        self.unseen = ~self.hit.any(axis=(1, 2))
        arriving = _total(size * (reference - integrated))
        squares = _total((size * stderr) ** 2)
        per_hit = np.divide(squares, arriving, out=np.zeros_like(arriving), where=arriving > 0.0)
        self.per_hit = np.where(self.unseen, 1.0 / max(rays, 1), per_hit)
        bsdf = np.maximum(model - integrated, 0.0)
        hits_per_energy = np.divide(1.0, self.per_hit, out=np.zeros_like(self.per_hit), where=self.per_hit > 0.0)
        self.n = bsdf * (size * hits_per_energy[:, None, None])
        inverse_size = np.divide(1.0, size, out=np.zeros_like(size), where=size > 0.0)
        self.variance = bsdf * (inverse_size * self.per_hit[:, None, None])
        self.few = self.n + self.n[..., ::-1] < FEW
        if not independent:
            doubtful = sampled.uncertain[direction] | sampled.uncertain[direction][..., ::-1]
            self.few &= doubtful
            self.variance *= doubtful

    @property
    def lonely(self):
        """Cells, shape (C, R, K), hit so often while their mirror image was not that they hold Dirac light."""
        return (self.effective >= FEW) & ~self.hit[..., ::-1]

    def variance_if_true(self, from_hits):
        """Variance of the squared error of a true model, shape (C,), and the part of it from cells with few hits.

        ``from_hits`` holds what the hits say of each cell, shape (C, R, K).
        """
        seen, expected = _total(self.few * self.effective), _total(self.few * self.n)
        limit = seen + 2.0 * np.sqrt(seen) + RULE_OF_THREE
        scale = np.minimum(1.0, np.divide(limit, expected, out=np.ones_like(expected), where=expected > 0.0))
        predicted = 2.0 * scale**2 * _total(self.few * (self._size * self.variance) ** 2)
        counted = _total(self.few * from_hits)
        few = np.maximum(predicted, counted)
        return _total(from_hits) - counted + few, few

    @property
    def hidden(self):
        """Squared error of three unseen hits in a cell of the mean size of those without a hit, shape (C,)."""
        empty = (self._size > 0.0) & ~self.hit
        cells, size = empty.sum(axis=(1, 2)), _total(self._size * empty)
        mean = np.divide(size, cells, out=np.ones_like(size), where=cells > 0)
        return np.where(cells > 0, (RULE_OF_THREE * self.per_hit) ** 2 / mean, 0.0)


def _effective(energy, stderr, n):
    if np.isfinite(n):
        return effective_count(energy, stderr, n)
    ratio = np.divide(energy, stderr, out=np.zeros_like(energy), where=stderr > 0.0)
    return ratio**2


def _total(values):
    return values.sum(axis=(-2, -1))
