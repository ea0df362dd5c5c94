"""Independent estimates of the same numbers, made one: as if all their light paths had been traced in one go.

Each counts by its light paths, and not by its errors: those are estimates too, and the smaller of two would pull the
mean to where there was less light by chance.
"""

import numpy as np

from ..result import Audit
from ..sums import Paths, sum_and_error
from .estimate import Estimate


def combined(one, other):
    """One estimate of two.

    Of independent paths, sums and sums of squares add up. Of replicates, means add up with the light paths as
    weights, and so their variances do.

    Parameters
    ----------
    one, other : goniosim.engine.estimate.Estimate
        By the same estimator, with ``paths``.

    Returns
    -------
    goniosim.engine.estimate.Estimate
    """
    if not one.paths or not other.paths:
        return one if one.paths else other
    share = other.paths / (one.paths + other.paths)
    energy = one.energy + share * (other.energy - one.energy)
    return (_of_paths if one.hits is not None else _of_replicates)(one, other, energy, share)


def _of_paths(one, other, energy, share):
    paths = one.paths + other.paths
    squares = sum(each.stderr**2 * (each.paths * (each.paths - 1.0)) for each in (one, other))
    squares += share * one.paths * (other.energy - one.energy) ** 2
    stderr = np.sqrt(squares / (paths * (paths - 1.0)))
    _, total_stderr = sum_and_error(energy, stderr, Paths(energy, paths))
    return Estimate(energy, stderr, total_stderr, paths, one.hits + other.hits, paths=paths)


def _of_replicates(one, other, energy, share):
    biases = [each.bias for each in (one, other) if each.bias is not None]
    return Estimate(
        energy,
        _error(one.stderr, other.stderr, share),
        _error(one.total_stderr, other.total_stderr, share),
        one.count + other.count,
        batches=one.batches + share * (other.batches - one.batches),
        # No more than this, since a norm of a mean is no more than the mean of the norms.
        bias=float(np.average(biases, weights=[1.0 - share, share][: len(biases)])) if biases else None,
        paths=one.paths + other.paths,
    )


def combined_audits(one, other):
    """One energy balance of two, each of which says how many rays it rests on.

    Parameters
    ----------
    one, other : goniosim.result.Audit

    Returns
    -------
    goniosim.result.Audit
        With the integrated direct reflection of the second.
    """
    rays = one.rays + other.rays
    share = np.divide(other.rays, rays, out=np.zeros(len(rays)), where=rays > 0)[:, None]
    return Audit(
        energy={name: value + share * (other.energy[name] - value) for name, value in one.energy.items()},
        stderr={name: _error(value, other.stderr[name], share) for name, value in one.stderr.items()},
        direct_integrated=other.direct_integrated,
        direct_integrated_stderr=other.direct_integrated_stderr,
        rays=rays,
    )


def _error(one, other, share):
    return np.sqrt(((1.0 - share) * one) ** 2 + (share * other) ** 2)
