"""Which of the incident directions a figure shows."""

import numpy as np

from ...errors import UnusableResultError
from .. import text

# How exactly an angle has to be given, in degrees.
TYPED = 1e-6


def spread(n, most):
    """Numbers of at most ``most`` of ``n`` directions, evenly picked: more would make unreadable pictures."""
    return sorted(set(np.linspace(0, n - 1, min(n, most)).round().astype(int).tolist()))


def chosen(theta_deg, wanted):
    """Numbers of the directions that somebody asks for.

    Parameters
    ----------
    theta_deg : ndarray, shape (M,)
        The directions that there are.
    wanted : sequence of float or None
        Angles in degrees; all directions if there are none.

    Returns
    -------
    list of int

    Raises
    ------
    UnusableResultError
        If an angle was not simulated.
    """
    if not wanted:
        return list(range(len(theta_deg)))
    numbers = []
    for angle in wanted:
        distance = np.abs(theta_deg - angle)
        nearest = int(np.argmin(distance))
        # Not a number is far from everything.
        if not distance[nearest] <= TYPED:
            simulated = ", ".join(text.angles(theta_deg))
            raise UnusableResultError(f"theta {text.degrees(angle)} was not simulated; there is {simulated}")
        numbers.append(nearest)
    return list(dict.fromkeys(numbers))
