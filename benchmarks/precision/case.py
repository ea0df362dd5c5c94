"""A function of goniosim beside its oracle, and how far the two are apart."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from mpmath import mp, mpf

# Of oracles, before cancellation: no argument lies closer than 1e-16 to a value at which something vanishes, and what
# vanishes there goes with its square, so that 40 digits remain.
DIGITS = 75
# Relative error that every function keeps to.
LIMIT = 1e-12
# Where a value is sensitive to its arguments, the error may be what so many half units in the last place of each do.
UNITS = 8
_HALF_UNIT = 2.0**-53


@dataclass(frozen=True)
class Case:
    """One number that a function returns.

    Attributes
    ----------
    name : str
        What is tested, as the page says it.
    arguments : tuple of str
    points : callable
        Of whether the grid is to be dense: the arguments, ndarray of shape (arguments, points).
    grid : str
        The same in words.
    kernel : callable
        Fills an ndarray of shape (outputs, points) from the arguments.
    exact : callable
        The oracle: mpf arguments to an mpf.
    row : int
        Which of the kernel's outputs it is.
    sensitive : str
        Where the value hangs on the last digits of its arguments, so that no program could keep to `LIMIT`; empty if
        it does nowhere.
    floor : float
        Smaller values need only be no larger.
    """

    name: str
    arguments: tuple[str, ...]
    points: Callable
    grid: str
    kernel: Callable
    exact: Callable
    row: int = 0
    sensitive: str = ""
    floor: float = 0.0


@dataclass(frozen=True)
class Outcome:
    """What a case came to.

    Attributes
    ----------
    points : int
    error : float
        The worst relative error.
    at : tuple of float
        Its arguments.
    condition : float
        Condition number there.
    beyond : int
        Points whose error is above `LIMIT`.
    units : float
        The worst error among these, in half units in the last place times the condition number.
    units_at : tuple of float or None
    """

    points: int
    error: float
    at: tuple[float, ...]
    condition: float
    beyond: int
    units: float
    units_at: tuple[float, ...] | None


def measure(case, dense):
    """The `Outcome` of a case, on the dense grid or on the coarse one."""
    points = np.ascontiguousarray(case.points(dense), dtype=float)
    found = values(case, points)
    with mp.workdps(DIGITS):
        errors = np.array([_error(case, *pair) for pair in zip(points.T, found, strict=True)])
        (beyond,) = np.nonzero(~(errors <= LIMIT))
        units = [_units(case, points[:, i], found[i]) for i in beyond]
        worst = int(np.argmax(errors))
        worst_condition = condition(case, points[:, worst])
    return Outcome(
        points.shape[1],
        float(errors[worst]),
        tuple(points[:, worst].tolist()),
        worst_condition,
        len(beyond),
        max(units, default=0.0),
        tuple(points[:, beyond[int(np.argmax(units))]].tolist()) if units else None,
    )


def values(case, points):
    """What goniosim finds."""
    found = np.full((case.row + 4, points.shape[1]), np.nan)
    case.kernel(points, found)
    return found[case.row]


def spread(case, point):
    """What a value changes by, if its arguments change one after the other by `UNITS` half units in the last place.

    Away from singularities this is ``UNITS`` half units of ``sum abs(x df/dx)``, the condition number times the value; at a
    root's, as next to the critical angle, it stays finite.
    """
    x = [mpf(float(a)) for a in point]
    value, total = case.exact(*x), mpf(0)
    for i, a in enumerate(x):
        moved = (case.exact(*x[:i], a * (1 + sign * UNITS * mpf(_HALF_UNIT)), *x[i + 1 :]) for sign in (-1, 1))
        total += max(abs(other - value) for other in moved)
    return total


def _error(case, point, value):
    """Relative error; 0 where both are below the floor."""
    if not np.isfinite(value):
        return np.inf
    exact = case.exact(*(mpf(float(a)) for a in point))
    if abs(exact) <= case.floor and abs(value) <= case.floor:
        return 0.0
    difference = abs(mpf(float(value)) - exact)
    return float(difference / abs(exact)) if exact != 0 else np.inf


def _units(case, point, value):
    """Error in `spread`, times `UNITS`."""
    exact, allowed = case.exact(*(mpf(float(a)) for a in point)), spread(case, point)
    return float(UNITS * abs(mpf(float(value)) - exact) / allowed) if allowed > 0 and np.isfinite(value) else np.inf


def condition(case, point):
    """How many times a relative error of the arguments grows, from `spread`; infinite where the value is 0."""
    exact = case.exact(*(mpf(float(a)) for a in point))
    return float(spread(case, point) / (UNITS * _HALF_UNIT * abs(exact))) if exact != 0 else np.inf
