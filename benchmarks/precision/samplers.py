"""Whether the maps from random numbers to directions have the densities they should, in the oracles' digits.

A map has a density if that, times the solid angle of what a small square of numbers is mapped to, is the square's area.
That goniosim computes the very maps, is what the cases of `benchmarks.precision.functions.sampling` show.
"""

from mpmath import cos, mp, mpf, pi, sin, sqrt

from .exact import ggx, lambert
from .outcome import DIGITS

# Relative, and below any distance of the numbers to an end.
_STEP = mpf("1e-30")


def visible_normals(cosines, widths, numbers, turns):
    """Largest deviation from 1 of the density of visible normals times the Jacobian of the map."""
    with mp.workdps(DIGITS):
        return max(
            abs(_visible(*map(mpf, point)) - 1)
            for point in ((z, a, u, t) for z in cosines for a in widths for u in numbers for t in turns)
        )


def cosine_directions(numbers, turns):
    """The same of directions with the density cos(theta) / pi."""
    with mp.workdps(DIGITS):
        return max(abs(_lambert(mpf(u), mpf(t)) - 1) for u in numbers for t in turns)


def _visible(z, alpha, u, turn):
    view = (sqrt(1 - z * z), mpf(0), z)

    def normal(u, turn):
        return ggx.visible_normal(*view, alpha, cos(2 * pi * turn), sin(2 * pi * turn), u)

    return ggx.visible_density(view, normal(u, turn), alpha) * _solid_angle(normal, u, turn)


def _lambert(u, turn):
    return lambert.cosine_direction(u, turn)[2] / pi * _solid_angle(lambert.cosine_direction, u, turn)


def _solid_angle(direction, u, turn):
    """Of what a square of numbers is mapped to, over its area."""
    by_u = _slope(lambda step: direction(u * (1 + step), turn), u)
    by_turn = _slope(lambda step: direction(u, turn * (1 + step)), turn)
    (a, b, c), (d, e, f) = by_u, by_turn
    return sqrt((b * f - c * e) ** 2 + (c * d - a * f) ** 2 + (a * e - b * d) ** 2)


def _slope(moved, x):
    return [(up - down) / (2 * _STEP * x) for up, down in zip(moved(_STEP), moved(-_STEP), strict=True)]
