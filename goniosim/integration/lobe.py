"""Where a density is narrower than the cells, so that its integration would miss it."""

import math
from dataclasses import dataclass

import numpy as np

# Parts that hold the peak are cut down to this share of the lobe's width; from there on errors show.
SHARE = 0.25
# The azimuth matters everywhere, on the scale of a radian.
WIDEST = 0.5
# Slopes up to which widths are proportional to the slope; those of wider lobes are taken from there.
SMALL = 0.1
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
    tilt = min(alpha, SMALL)
    u, psi = grid.module.coordinates(_mirror(light, 0.0, 0.0), grid.light)
    # Not tilted so far that the facet turns its back to the light. A tilt towards the light by its own angle
    # would send it back to where it came from: of both sides, the outer one counts.
    across = [slope for slope in (-tilt, tilt) if light[2] + slope * light[0] > 0.0]
    width = max(abs(grid.module.coordinates(_mirror(light, slope, 0.0), grid.light)[0] - u) for slope in across)
    _, around = grid.module.coordinates(_mirror(light, 0.0, tilt), grid.light)
    turn = abs(math.remainder(around - psi, 2.0 * math.pi))
    return Lobe(u, abs(psi), _scale(width, u, alpha / tilt), _scale(turn, psi, alpha / tilt))


def _scale(width, at, times):
    return min(SHARE * times * width, WIDEST) if width > RESOLVED * np.spacing(abs(at)) else 0.0


def _mirror(light, slope_x, slope_y):
    """The light, mirrored at a facet whose normal is (slope_x, slope_y, 1)."""
    facet = np.array([slope_x, slope_y, 1.0]) / math.sqrt(1.0 + slope_x**2 + slope_y**2)
    return 2.0 * (light @ facet) * facet - light
