"""Samplers against 40 digits: their maps are computed as they should be, and have the densities they should."""

from benchmarks.precision.case import measure
from benchmarks.precision.functions import GROUPS
from benchmarks.precision.table import deviations
from precise import GRIDS, each, holds

CASES = GROUPS["sampling"]


@each(CASES, "sample_visible")
def test_sample_visible_normal(case, dense):
    """Facets that all but face the view: a root of 1 - z^2 once left no digits to those of small random numbers."""
    holds(case, measure(case, dense))


@each(CASES, "sample_cosine")
def test_sample_cosine(case, dense):
    """The smallest and largest random numbers: the normal, the horizon and the axes."""
    holds(case, measure(case, dense))


@GRIDS
def test_the_maps_of_the_oracles_are_samplers(dense):
    """Density times Jacobian is 1: D, G1 and the map belong together, at any width and height."""
    assert max(deviations(dense)) < 1e-25
