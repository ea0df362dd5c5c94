"""Which of the incident directions a figure shows."""

import numpy as np

from ...errors import UnusableResultError
from .. import text


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
        (found,) = np.nonzero(np.isclose(theta_deg, angle, rtol=0.0, atol=1e-6))
        if not found.size:
            simulated = ", ".join(map(text.degrees, theta_deg))
            raise UnusableResultError(f"theta {text.degrees(angle)} was not simulated; there is {simulated}")
        numbers.append(int(found[0]))
    return numbers
