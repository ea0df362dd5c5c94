"""Where a density is narrower than the cells, so that its integration would miss it."""

import math
from dataclasses import dataclass

import numpy as np

# Parts that hold the peak are cut down to this share of the lobe's width; from there on errors show.
SHARE = 0.25
# The azimuth matters everywhere, on the scale of a radian.
WIDEST = 0.5
# Spacings of the numbers around a peak below which its lobe cannot be told from a Dirac.
RESOLVED = 16


@dataclass(frozen=True)
class Lobe:
    """The peak of a density, in the coordinates of a slice.

    Attributes
    ----------
    u, psi : float
        Row coordinate of the peak, and its azimuth from the mirror direction of the light of the slice, in radians.
    scale_u, scale_psi : float
        Extent of the parts of a cell in which the peak shows; 0 if no part is so small.
    """

    u: float
    psi: float
    scale_u: float
    scale_psi: float


def find_lobe(grid, light, alpha):
    """The lobe of a GGX reflection about the mirror image of ``light``.

    A half vector tilted by alpha out of the plane of incidence turns the azimuth of v by
    2 alpha cot(theta): at grazing incidence the lobe is a needle. The widths are those of the
    images of half vectors that are tilted so.

    Parameters
    ----------
    grid : Grid
    light : ndarray, shape (3,)
    alpha : float
        GGX width, > 0.

    Returns
    -------
    Lobe
    """
    u, psi = grid.module.coordinates(_mirror(light, 0.0, 0.0), grid.light)
    across = [grid.module.coordinates(_mirror(light, sign * alpha, 0.0), grid.light)[0] for sign in (-1.0, 1.0)]
    _, around = grid.module.coordinates(_mirror(light, 0.0, alpha), grid.light)
    turn = abs(math.remainder(around - psi, 2.0 * math.pi))
    width = min((abs(end - u) for end in across if end != u), default=0.0)
    return Lobe(u, abs(psi), _scale(width, u), _scale(turn, psi))


def _scale(width, at):
    return min(SHARE * width, WIDEST) if width > RESOLVED * np.spacing(abs(at)) else 0.0


def _mirror(light, slope_x, slope_y):
    """The light, mirrored at a facet whose normal is (slope_x, slope_y, 1)."""
    facet = np.array([slope_x, slope_y, 1.0]) / math.sqrt(1.0 + slope_x**2 + slope_y**2)
    return 2.0 * (light @ facet) * facet - light
