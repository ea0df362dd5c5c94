"""The Lambertian reflector: radiance independent of direction, BRDF rho / pi."""

import math

from .._jit import scalar
from .elementary import sincos_turns


@scalar
def sample_cosine(u1, u2):
    """A unit direction of the upper hemisphere with density cos(theta) / pi."""
    sine, cosine = sincos_turns(u2)
    return cosine_direction(u1, cosine, sine)


@scalar
def cosine_direction(u, cosine, sine):
    """As `sample_cosine`, from the cosine and sine of a uniform azimuth."""
    radius = math.sqrt(u)
    return radius * cosine, radius * sine, math.sqrt(1.0 - u)
