"""Slices as the eye sees them from above: disks on a board that covers the whole figure.

One board for all disks, since axes of their own would cost more time than what is drawn in them.
"""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, FancyArrowPatch, Rectangle
from matplotlib.patheffects import withStroke

from . import tone, view
from .panels import DIRAC, INK, INVALID_GREY, INVALID_STRIPE, LIGHT, UNSEEN

# Room around a disk in units of its radius; the light arrives from the left.
MARGIN, ARROW_TAIL = 1.04, 1.3
# Width over height of a disk with its room.
ASPECT = (ARROW_TAIL + MARGIN) / (2.0 * MARGIN)
RINGS_DEG = (30.0, 60.0)
# Stripes of the hatch of invalid cells across a disk.
STRIPES = 60


class Board:
    """Axes over the whole figure, in inches from its upper left corner.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    """

    def __init__(self, figure):
        width, height = figure.get_size_inches()
        self._axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self._axes.set_axis_off()
        self._axes.set_xlim(0.0, width)
        self._axes.set_ylim(height, 0.0)
        self._axes.autoscale(False)

    def disk(self, left, top, height):
        """Room for one disk.

        Parameters
        ----------
        left, top, height : float
            In inches; the width is ``ASPECT`` times the height.

        Returns
        -------
        Disk
        """
        radius = 0.5 * height / MARGIN
        return Disk(self._axes, left + ARROW_TAIL * radius, top + 0.5 * height, radius)

    def closer(self, middle, top, size, slices, numbers, scale, unseen, words):
        """Draw a lobe enlarged, in bands of luminance.

        Parameters
        ----------
        middle, top, size : float
            Of the square, in inches.
        slices, scale, unseen
            As in `Disk.bands`.
        numbers : ndarray of int64, shape (pixels, pixels)
            From `view.magnified`.
        words : str
            To stand below.
        """
        image = _image(_band_colours(slices, numbers, scale), numbers, unseen, UNSEEN[1])
        extent = (middle - 0.5 * size, middle + 0.5 * size, top + size, top)
        self._axes.imshow(image, extent=extent, aspect="auto", interpolation="antialiased")
        frame = Rectangle((extent[0], top), size, size, fill=False, color=INK, linewidth=0.8)
        self._axes.add_artist(frame)
        self._axes.text(middle, top + size + 0.02, words, ha="center", va="top", color="0.3", fontsize=7)


@dataclass(frozen=True)
class Disk:
    """Where a disk stands: its centre and radius in inches."""

    axes: Axes
    x: float
    y: float
    radius: float

    def colour(self, slices, numbers, theta_deg, white, spot=None, unseen=None):
        """Draw a slice in remapped colours.

        Parameters
        ----------
        slices : ndarray, shape (C, R, K)
            BSDF in 1/sr.
        numbers : ndarray of int64, shape (pixels, pixels)
            From `view.disk`.
        theta_deg : float
            Where the light stands.
        white : float
            BSDF shown at full brightness, in 1/sr.
        spot : ndarray of 3 floats, optional
            Direction of a Dirac part, to be ringed: its cell may be too small to be seen.
        unseen : ndarray of bool, shape (R, K), optional
            Cells that were not hit, from `panels.unseen_cells`.
        """
        self._show(tone.exposed(view.pixel_values(slices, numbers), white), numbers, unseen, UNSEEN[0])
        self._furnish(theta_deg, spot)

    def bands(self, slices, numbers, theta_deg, scale, spot=None, unseen=None):
        """Draw the luminance of a slice in bands of false colours between round values.

        Parameters
        ----------
        slices, numbers, theta_deg, spot, unseen
            As in `colour`.
        scale : matplotlib.cm.ScalarMappable or None
            From `bands.scale`; None draws black.
        """
        self._show(_band_colours(slices, numbers, scale), numbers, unseen, UNSEEN[1])
        self._furnish(theta_deg, spot)

    def above(self, words, **look):
        """Write above the disk."""
        look["parse_math"] = False
        self.axes.text(self.x, self.y - 1.07 * self.radius, words, ha="center", va="bottom", **look)

    def below(self, words, **look):
        """Write below the disk."""
        self.axes.text(self.x, self.y + 1.07 * self.radius, words, ha="center", va="top", color="0.3", **look)

    def _show(self, colours, numbers, unseen, unseen_colour):
        image = _image(colours, numbers, unseen, unseen_colour)
        r = self.radius
        extent = (self.x - r, self.x + r, self.y + r, self.y - r)
        self.axes.imshow(image, extent=extent, aspect="auto", interpolation="antialiased")

    def _furnish(self, theta_deg, spot):
        """Rim, rings at 30 and 60 degrees, the light as an arrow outside and a ring where it stands."""
        for ring in RINGS_DEG:
            self._circle(np.sin(np.radians(ring)), color="0.6", alpha=0.6, linewidth=0.6)
        self._circle(1.0, color=INK, linewidth=1.2)
        if spot is not None:
            # Turned by half a circle, and downwards is positive.
            self._ring(-spot[0], spot[1], markersize=9, color=DIRAC)
        stroke = [withStroke(linewidth=2.8, foreground=INK)]
        where = -np.sin(np.radians(theta_deg))
        self._ring(where, 0.0, markersize=7, color=LIGHT, markeredgewidth=1.5, path_effects=stroke)
        if theta_deg > 0.0:
            arrow = FancyArrowPatch(
                (self.x - ARROW_TAIL * self.radius, self.y),
                (self.x - 1.03 * self.radius, self.y),
                arrowstyle="simple,head_length=6,head_width=8,tail_width=2.5",
                facecolor=LIGHT,
                edgecolor=INK,
                linewidth=0.7,
                shrinkA=0.0,
                shrinkB=0.0,
            )
            self.axes.add_artist(arrow)

    def _circle(self, radius, **look):
        self.axes.add_artist(Circle((self.x, self.y), radius * self.radius, fill=False, **look))

    def _ring(self, x, y, **look):
        place = [self.x + x * self.radius], [self.y + y * self.radius]
        self.axes.plot(*place, "o", markerfacecolor="none", **look)


def _image(colours, numbers, unseen, unseen_colour):
    """Colours and opacity of all pixels: what was not hit, and what has no value, in colours of their own."""
    image = np.dstack([colours, numbers != view.OUTSIDE])
    if unseen is not None:
        image[(numbers >= 0) & unseen.ravel()[np.maximum(numbers, 0)], :3] = unseen_colour
    across = np.add(*np.indices(numbers.shape)) * STRIPES // len(numbers)
    image[numbers == view.INVALID, :3] = INVALID_GREY
    image[(numbers == view.INVALID) & (across % 2 == 1), :3] = INVALID_STRIPE
    return image


def _band_colours(slices, numbers, scale):
    shown = tone.luminance(view.pixel_values(slices, numbers))
    if scale is None:
        return np.zeros((*shown.shape, 3))
    inside_the_last = 0.5 * sum(scale.norm.boundaries[-2:])
    return scale.to_rgba(np.minimum(shown, inside_the_last))[..., :3]
