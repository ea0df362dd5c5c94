"""The scale of top views: that of one entry of a direction, on which all of them are drawn."""

from functools import cached_property

import numpy as np

from ..drawing import bands, panels, tone, view

# Bands that are fainter than this share of the brightest show nothing of interest.
FAINTEST = 1e-5


class Scale:
    """Draws the entries of a direction from above.

    Parameters
    ----------
    direction : goniosim.report.comparison.entries.Direction
    pixels : int
        Along each side of a disk.
    """

    def __init__(self, direction, pixels):
        self._direction = direction
        self._numbers = direction.disk(pixels)
        # A Dirac part would leave all the rest in the dark.
        self._slices = [panels.without_cell(entry.slices, entry.dirac) for entry in direction.entries]
        self._own = self._slices[direction.entries.index(direction.scaling)]

    def explanation(self, bands=True):
        """What hatched cells are, and cells that were not hit, if there are any; with or without ``bands``."""
        words = "; hatched: cells cut by the horizon" if (self._numbers == view.INVALID).any() else ""
        unseen = any(entry.unseen is not None for entry in self._direction.entries)
        colours = "slate, or pale among the bands" if bands else "slate"
        return words + (f"; {colours}: cells without a hit" if unseen else "")

    @cached_property
    def white(self):
        """BSDF shown at full brightness, in 1/sr."""
        return tone.white_point(view.pixel_values(self._own, self._numbers)[self._numbers >= 0])

    @cached_property
    def bands(self):
        """Bands of luminance, see `bands.scale`; None in the dark."""
        own = bands.extent(self._own, self._numbers)
        if own is None:
            return None
        # Noise makes speckles, faint and bright ones. What is faint, models say as well; what is bright, the curve.
        lows = [found[0] for slices in self._slices if (found := bands.extent(slices, self._numbers))]
        high = min(own[1], self._direction.scaling.highest)
        return bands.scale(float(np.clip(np.median(lows), FAINTEST * high, high)), high)

    def draw_colour(self, disk, entry):
        """Draw an entry in colour."""
        disk.colour(entry.slices, self._numbers, self._direction.theta_deg, self.white, **self._marks(entry))

    def draw_bands(self, disk, entry):
        """Draw the luminance of an entry in bands."""
        disk.bands(entry.slices, self._numbers, self._direction.theta_deg, self.bands, **self._marks(entry))

    def _marks(self, entry):
        return {"spot": self._direction.spot(entry), "unseen": entry.unseen}
