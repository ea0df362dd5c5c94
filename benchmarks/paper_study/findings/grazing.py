"""What the findings at grazing angles share: where light and viewer stand, and what is summed there."""

from ..slices import ratio

# Light and viewer at grazing angles, in degrees.
LIGHTS, VIEWER = (75, 85), 75.0
RED, GREEN, BLUE = range(3)


def beyond(slices, found, theta_deg, least=VIEWER):
    """Energy of each channel beyond a polar angle of the viewer, as a list of `Value`."""
    m = slices.direction(theta_deg)
    return slices.region(found, m, slices.polar(m) > least)


def green_over_red(energies):
    """Ratio of the first two channels as a `Value`: small for a red light, 1 for an achromatic one."""
    return ratio(energies[GREEN], energies[RED])
