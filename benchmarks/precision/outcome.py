"""How far numbers are from what they should be, and how far they may be."""

from dataclasses import dataclass

import numpy as np
from mpmath import mp, mpf

# Of oracles, before cancellation: no argument lies closer than 1e-16 to a value at which something vanishes, and what
# vanishes there goes with its square, so that 40 digits remain.
DIGITS = 75
# Relative error that everything keeps to.
LIMIT = 1e-12
# Where a value is sensitive to its arguments, the error may be what so many half units in the last place of each do.
UNITS = 4
_HALF_UNIT = 2.0**-53


@dataclass(frozen=True)
class Outcome:
    """What a comparison came to.

    Attributes
    ----------
    points : int
    error : float
        The worst relative error, where the value is not 0.
    at : tuple of float
        Its arguments.
    condition : float
        Condition number there.
    beyond : int
        Points whose error is above `LIMIT`, or that are not 0 where they should be.
    units : float
        The worst error among these, in what half a unit in the last place of the arguments does.
    """

    points: int
    error: float
    at: tuple[float, ...]
    condition: float
    beyond: int
    units: float


def compare(points, found, exact, spread_at, floor=0.0):
    """The `Outcome` of numbers beside exact ones.

    Parameters
    ----------
    points : list of tuple of float
        Arguments.
    found : sequence of float
    exact : list of mpf
    spread_at : callable
        `spread` of the point of a number.
    floor : float
        Smaller values need only be no larger.
    """
    with mp.workdps(DIGITS):
        errors = np.array([_error(*pair, floor) for pair in zip(found, exact, strict=True)])
        (beyond,) = np.nonzero(~(errors <= LIMIT))
        units = [_units(found[i], exact[i], spread_at(i)) for i in beyond]
        worst = int(np.argmax(np.where(np.isfinite(errors), errors, -1.0)))
        condition = _condition(exact[worst], spread_at(worst))
    return Outcome(len(points), float(errors[worst]), points[worst], condition, len(beyond), max(units, default=0.0))


def spread(exact, arguments):
    """What a value changes by, if its arguments change one after the other by `UNITS` half units in the last place.

    Away from singularities this is ``UNITS`` half units of ``sum abs(x df/dx)``, the condition number times the value;
    at that of a root, as at the critical angle, it stays finite.
    """
    value, total = exact(*arguments), mpf(0)
    for i, a in enumerate(arguments):
        steps = (a * (1 + sign * UNITS * mpf(_HALF_UNIT)) for sign in (-1, 1))
        total += max(abs(exact(*arguments[:i], step, *arguments[i + 1 :]) - value) for step in steps)
    return total


def _error(found, exact, floor):
    """Relative error; 0 where both are below the floor."""
    if not np.isfinite(found):
        return np.inf
    if abs(exact) <= floor and abs(found) <= floor:
        return 0.0
    return float(abs(mpf(float(found)) - exact) / abs(exact)) if exact != 0 else np.inf


def _units(found, exact, allowed):
    if not np.isfinite(found) or allowed == 0:
        return np.inf
    return float(UNITS * abs(mpf(float(found)) - exact) / allowed)


def _condition(exact, allowed):
    """How many times a relative error of the arguments grows; infinite where the value is 0."""
    return float(allowed / (UNITS * _HALF_UNIT * abs(exact))) if exact != 0 else np.inf
