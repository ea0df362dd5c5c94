"""What the tests of precision share: the cases of `benchmarks.precision` for a function, and their limits."""

import pytest

from benchmarks.precision.outcome import UNITS

# A coarse grid in `make test`, the dense one of docs/precision.md in `make test-all`.
GRIDS = pytest.mark.parametrize("dense", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["coarse", "dense"])


def each(cases, *functions):
    """Parametrise a test over the cases of some functions, and over both grids."""
    chosen = [case for case in cases if case.name.startswith(functions)]
    assert chosen

    def decorate(test):
        return GRIDS(pytest.mark.parametrize("case", chosen, ids=lambda case: case.name)(test))

    return decorate


def holds(case, outcome):
    """A relative 1e-12; where it is said what a value is sensitive to, a few roundings of its arguments."""
    if case.sensitive:
        assert outcome.units <= UNITS, outcome
    else:
        assert outcome.beyond == 0, outcome
