"""Every estimator against closed forms, cell by cell: never worse than independent paths would be.

The chi-squares are in units of what independent paths scatter, which the estimators must undercut: an estimator that is
biased by as much as the noise of 200,000 paths fails. A right one hardly ever does: one that scattered as much as paths
do would exceed the limit with a probability of 1.2e-5 in each of two slices of 108 blocks, and of less in cells.
"""

import itertools

import pytest

from reference import checks

THETAS = [0, 60]
RAYS = 200_000


def assert_better_than_paths(chi_squares):
    for found in itertools.chain(*chi_squares):
        assert found.per_dof < 1.0 + 5.0 * (2.0 / found.dof) ** 0.5, f"{chi_squares}"


@pytest.mark.false_alarm(3e-5, seeds=(11, 111))
@pytest.mark.parametrize("estimator", ["connection", "split"])
@pytest.mark.parametrize("parametrization", ["classic", "half"])
def test_smooth_plastic(parametrization, estimator, seed):
    assert_better_than_paths(checks.plastic_cells(THETAS, parametrization, RAYS, seed, estimator))


@pytest.mark.false_alarm(3e-5, seeds=(12, 112))
@pytest.mark.parametrize(
    ("alpha", "estimator", "parametrization"),
    [
        (0.2, "operator", "classic"),
        (0.2, "split", "half"),
        *(pytest.param(alpha, "operator", "half", marks=pytest.mark.slow) for alpha in (0.05, 0.2, 1.0)),
        *(pytest.param(alpha, "operator", "classic", marks=pytest.mark.slow) for alpha in (0.05, 1.0)),
        pytest.param(0.2, "split", "classic", marks=pytest.mark.slow),
    ],
)
def test_rough_conductor(parametrization, alpha, estimator, seed):
    assert_better_than_paths(checks.conductor_cells(alpha, THETAS, parametrization, RAYS, seed, estimator))


@pytest.mark.false_alarm(3e-5, seeds=(13, 113))
@pytest.mark.parametrize("eta", [1.5, 1.0 / 1.5])
@pytest.mark.parametrize("alpha", [0.2, *(pytest.param(alpha, marks=pytest.mark.slow) for alpha in (0.001, 1.0))])
def test_transmission_of_a_rough_interface(alpha, eta, seed):
    assert_better_than_paths(checks.transmission_cells(alpha, eta, THETAS, RAYS, seed, "split"))
