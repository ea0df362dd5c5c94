"""Refraction of directions that point away from the interface, on either side of it.

A direction w on the upper side, at the cosine c from the unit vector m, belongs to the
direction ``ratio * w + k * m`` below, where ``ratio`` = n_above / n_below and k keeps it a unit vector.
"""

import math

from .._jit import scalar
from .elementary import fma


@scalar
def refracted_cosine(cosine, ratio):
    """Cosine below for the cosine above; 0 under total internal reflection.

    Cosines keep the digits that a squared sine close to 1 has lost. So does 1 - ratio^2 + (ratio cosine)^2 at the
    critical angle, where it cancels: the two squares are taken with their rounding errors.

    Parameters
    ----------
    cosine : float
        Of the angle to the axis of refraction, above; in [0, 1].
    ratio : float
        Index above over index below.
    """
    # Not ratio * ratio, which the compiler may contract with the difference below; that is exact where much cancels.
    squared = fma(ratio, ratio, 0.0)
    scaled = ratio * cosine
    rest = 2.0 * scaled * fma(ratio, cosine, -scaled) - fma(ratio, ratio, -squared)
    return math.sqrt(max(0.0, fma(scaled, scaled, 1.0 - squared) + rest))


@scalar
def refraction_shift(cosine, ratio, below):
    """The k of the direction below, ``below - ratio * cosine`` without a difference of nearly equal numbers.

    Parameters
    ----------
    cosine, ratio : float
        As in `refracted_cosine`.
    below : float
        What that returned; where it is 0, k means nothing.
    """
    return (1.0 - ratio) * (1.0 + ratio) / max(below + ratio * cosine, 1e-30)
