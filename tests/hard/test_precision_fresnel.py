"""Fresnel and Snell against 40 digits: a relative 1e-12 from grazing to normal incidence, for any index."""

from benchmarks.precision.case import measure
from benchmarks.precision.functions import GROUPS
from precise import each, holds

FRESNEL, REFRACTION = GROUPS["fresnel"], GROUPS["refraction"]


@each(FRESNEL, "fresnel_dielectric")
def test_fresnel_dielectric(case, dense):
    """(c - g) / (c + g) has no digits left where indices are nearly equal, and g none at the critical angle."""
    holds(case, measure(case, dense))


@each(FRESNEL, "dielectric_transmittance")
def test_dielectric_transmittance(case, dense):
    """1 - R has no digits left at grazing incidence, where R is nearly 1."""
    holds(case, measure(case, dense))


@each(FRESNEL, "scaled_transmittance")
def test_scaled_transmittance(case, dense):
    """The same at normals of any length; it once was 1 - R, and at a cosine of 1e-10 had six digits."""
    holds(case, measure(case, dense))


@each(FRESNEL, "reflects")
def test_reflects(case, dense):
    """The coin is thrown without a division: the number at which it turns must be the reflectance all the same."""
    holds(case, measure(case, dense))


@each(FRESNEL, "fresnel_conductor", "conductor_absorptance")
def test_fresnel_conductor_and_absorptance(case, dense):
    """1 - R of a mirror, R of a conductor like what is around it, and no absorption next to the critical angle."""
    holds(case, measure(case, dense))


@each(REFRACTION, "refracted_cosine")
def test_refracted_cosine(case, dense):
    """1 - r^2 + (r c)^2 cancels at the critical angle; rounding the squares left a cosine of 1e-5 six digits."""
    holds(case, measure(case, dense))


@each(REFRACTION, "refraction_shift")
def test_refraction_shift(case, dense):
    """A difference of the two cosines, which are nearly equal next to an index of 1."""
    holds(case, measure(case, dense))
