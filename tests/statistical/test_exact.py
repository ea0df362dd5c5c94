"""Every estimator against closed forms, cell by cell: never worse than independent paths would be.

The chi-squares are in units of what independent paths scatter, which the estimators must undercut: an estimator that is
biased by as much as the noise of two million paths fails. A right one fails never, as far as 1e-6 counts.
"""

import itertools

import pytest

from reference import checks

THETAS = [0, 30, 60]
RAYS = 500_000


def assert_better_than_paths(chi_squares):
    for found in itertools.chain(*chi_squares):
        assert found.per_dof < 1.0 + 5.0 * (2.0 / found.dof) ** 0.5, f"{chi_squares}"


@pytest.mark.parametrize("estimator", ["connection", "split"])
@pytest.mark.parametrize("parametrization", ["classic", "half"])
def test_smooth_plastic(parametrization, estimator):
    assert_better_than_paths(checks.plastic_cells(THETAS, parametrization, RAYS, 11, estimator))


@pytest.mark.parametrize(
    ("alpha", "estimator"), [(0.05, "operator"), (0.2, "operator"), (1.0, "operator"), (0.2, "split")]
)
@pytest.mark.parametrize("parametrization", ["classic", "half"])
def test_rough_conductor(parametrization, alpha, estimator):
    assert_better_than_paths(checks.conductor_cells(alpha, THETAS, parametrization, RAYS, 12, estimator))


@pytest.mark.parametrize("eta", [1.5, 1.0 / 1.5])
@pytest.mark.parametrize("alpha", [0.001, 0.2, 1.0])
def test_transmission_of_a_rough_interface(alpha, eta):
    assert_better_than_paths(checks.transmission_cells(alpha, eta, THETAS, RAYS, 13, "split"))
