"""Short polynomials and the law of Beer against 40 digits, in relative error: zeros of sines included."""

from benchmarks.precision.case import measure
from benchmarks.precision.functions import GROUPS
from precise import each, holds

ELEMENTARY, MEDIUM = GROUPS["elementary"], GROUPS["medium"]


@each(ELEMENTARY, "sincos")
def test_sincos(case, dense):
    """Small sines and cosines are directions next to an axis or to the horizon, where an absolute error would show."""
    holds(case, measure(case, dense))


@each(ELEMENTARY, "exp_nonpositive")
def test_exp_nonpositive(case, dense):
    """k ln 2 is subtracted from arguments as large as 700."""
    holds(case, measure(case, dense))


@each(ELEMENTARY, "arctan2_first_quadrant", "azimuth")
def test_arctan2_and_azimuth(case, dense):
    """Tangents from 1e-30 to 1e30, and points of any length: theta_h next to the pole is one of them."""
    holds(case, measure(case, dense))


@each(MEDIUM, "transmittance, path_length")
def test_transmittance_of_a_medium(case, dense):
    """tau / cos of 1e4 and more is black and not a subnormal; tau of 1e-12 takes nothing."""
    holds(case, measure(case, dense))
