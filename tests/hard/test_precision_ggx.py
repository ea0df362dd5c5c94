"""Microfacets against 40 digits: alpha from 1e-6 to 1, from the normal to the horizon."""

from benchmarks.precision.case import measure
from benchmarks.precision.functions import GROUPS
from precise import each, holds

GGX, MICROFACET = GROUPS["ggx"], GROUPS["microfacet"]


@each(GGX, "ggx_density")
def test_ggx_density(case, dense):
    """cos^2 (alpha^2 - 1) + 1 cancels for narrow distributions, and theta_h = 1e-12 is nothing to an arc cosine."""
    holds(case, measure(case, dense))


@each(GGX, "smith_g1")
def test_smith_g1(case, dense):
    """Lambda overflows at the horizon and vanishes at the normal; with and without a scale."""
    holds(case, measure(case, dense))


@each(GGX, "height_correlation")
def test_height_correlation(case, dense):
    """1 / (1 + Lambda + Lambda) where both directions are all but masked, and where neither is."""
    holds(case, measure(case, dense))


@each(MICROFACET, "microfacet_reflection")
def test_microfacet_reflection(case, dense):
    """Half vectors 1e-12 rad from the mirror direction must not drown in the rounding of their sum."""
    holds(case, measure(case, dense))


@each(MICROFACET, "microfacet_transmission")
def test_microfacet_transmission(case, dense):
    """As reflection, and with eta l + v that all but cancels next to an index of 1."""
    holds(case, measure(case, dense))
