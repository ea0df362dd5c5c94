"""The Lambertian reflector: radiance independent of direction, BRDF rho / pi."""

import math

from .._jit import scalar
from .elementary import sincos_turns


@scalar
def sample_cosine(u1, u2):
    """A unit direction of the upper hemisphere with density cos(theta) / pi."""
    radius = math.sqrt(u1)
    sine, cosine = sincos_turns(u2)
    return radius * cosine, radius * sine, math.sqrt(1.0 - u1)
