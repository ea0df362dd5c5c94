"""Refraction of directions that point away from the interface, on either side of it.

A direction w on the upper side, at the cosine c from the unit vector m, belongs to the
direction ``ratio * w + k * m`` below, where ``ratio`` = n_above / n_below and k keeps it a unit vector.
"""

import math

from .._jit import scalar


@scalar
def refracted_cosine(sin2, ratio):
    """Cosine below for the squared sine above; 0 under total internal reflection.

    Parameters
    ----------
    sin2 : float
        Squared sine of the angle to the axis of refraction, above.
    ratio : float
        Index above over index below.
    """
    return math.sqrt(max(0.0, 1.0 - ratio * ratio * sin2))
