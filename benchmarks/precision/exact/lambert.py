"""Directions with the density cos(theta) / pi."""

from mpmath import cospi, sinpi, sqrt


def cosine_direction(u1, u2):
    """Squared sine ``u1`` and azimuth ``2 pi u2``."""
    radius = sqrt(u1)
    return radius * cospi(2 * u2), radius * sinpi(2 * u2), sqrt(1 - u1)
