"""A function of goniosim beside its oracle."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from mpmath import mp, mpf

from .outcome import DIGITS, compare, spread


@dataclass(frozen=True)
class Case:
    """One number that a function returns.

    Attributes
    ----------
    name : str
        What is tested, as the page says it; the name of the function comes first.
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


# Of a kernel, at the most.
_OUTPUTS = 4


def measure(case, dense):
    """The `Outcome` of a case, on the dense grid or on the coarse one."""
    points = np.ascontiguousarray(case.points(dense), dtype=float)
    found = np.full((_OUTPUTS, points.shape[1]), np.nan)
    case.kernel(points, found)
    with mp.workdps(DIGITS):
        arguments = [tuple(map(mpf, point)) for point in points.T.tolist()]
        exact = [case.exact(*point) for point in arguments]
    given = list(map(tuple, points.T.tolist()))
    return compare(given, found[case.row], exact, lambda i: spread(case.exact, arguments[i]), case.floor)
