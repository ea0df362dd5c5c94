"""What an accuracy costs: a time for each error of the list, and how it is known."""

from dataclasses import dataclass

import numpy as np

# Relative errors of a slice, from easy to hard.
ERRORS = (0.1, 0.03, 0.01, 0.003, 0.001)
# Logarithm of a factor at which nothing is known any more.
MOST_UNKNOWN = 7.0


@dataclass(frozen=True)
class Price:
    """Of one component, with one estimator.

    Attributes
    ----------
    error : float
        Norm of Eq. 4 of the standard error over the norm of the slice, to be met in every direction.
    seconds, cpu_seconds : float
        Time of the whole run, each direction with the rays that it needs.
    measured : bool
        Whether runs of the ladder reached that error; otherwise it is predicted.
    uncertainty : float
        Standard error of the times, relative.
    """

    error: float
    seconds: float
    cpu_seconds: float
    measured: bool
    uncertainty: float


def price(law, error):
    """What an error costs; None where the component is black, or all of it noise.

    Parameters
    ----------
    law : goniosim.report.cost.fit.Law
    error : float

    Returns
    -------
    Price or None
    """
    lit = np.isfinite(law.level)
    if not lit.any():
        return None
    rays, unknown = (values[lit] for values in law.rays(error))
    # Nothing is known of runs smaller than the first.
    small = rays < law.fewest
    rays, unknown = np.where(small, law.fewest, rays), np.where(small, 0.0, unknown)
    fixed, growing = law.fixed[:, lit], law.per_ray[:, lit] * rays
    total = law.overhead + (fixed + growing).sum(axis=1)
    # The directions may be wrong all alike.
    off = np.hypot((growing[1] * unknown).sum(), law.clock * total[1])
    return Price(
        error=error,
        seconds=float(total[0]),
        cpu_seconds=float(total[1]),
        measured=bool(rays.max() <= law.most),
        uncertainty=float(np.expm1(min(off / total[1], MOST_UNKNOWN))),
    )


def prices(law):
    """A `Price` for each of `ERRORS`; empty where the component is black."""
    found = [price(law, error) for error in ERRORS]
    return [each for each in found if each is not None]
