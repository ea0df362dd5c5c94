"""The laws of a price list: recovered from made-up ladders whose laws are known."""

import numpy as np
import pytest

from goniosim.report.cost.fit import fit
from goniosim.report.cost.prices import ERRORS, price, prices
from goniosim.report.cost.runs import Run

NAME = "reflection/internal"
NORM = np.array([2.0, 4.0])


def ladder(slope, fixed=0.05, per_ray=1e-7, rays=(1e4, 4e4, 16e4, 64e4), level=10.0, seed=None):
    """Runs of two directions, the second with half the relative error of the first."""
    rng = np.random.default_rng(seed)
    rungs = []
    for n in rays:
        error = level * n**-slope * np.array([1.0, 0.5])
        if seed is not None:
            error = error * np.exp(0.05 * rng.normal())
        cpu = np.full(2, fixed + per_ray * n)
        rungs.append(Run(np.full(2, n), 0.5 * cpu, cpu, 0.2, 0.3, {NAME: error * NORM}, {NAME: NORM}, {}, None))
    return rungs


@pytest.mark.parametrize(("slope", "independent"), [(0.5, True), (0.8, False)])
def test_a_law_is_recovered_from_an_exact_ladder(slope, independent):
    law = fit(ladder(slope), NAME, NORM, independent)
    assert law.slope == pytest.approx(slope)
    assert law.error(1e6) == pytest.approx(10.0 * 1e6**-slope * np.array([1.0, 0.5]))
    found = price(law, 0.001)
    rays = (10.0 / 0.001 * np.array([1.0, 0.5])) ** (1.0 / slope)
    cpu = (0.05 + 1e-7 * rays).sum()
    assert found.cpu_seconds == pytest.approx(0.3 + cpu)
    assert found.seconds == pytest.approx(0.2 + 0.5 * cpu)


def test_what_the_ladder_reached_is_measured_and_the_rest_predicted_less_surely():
    law = fit(ladder(0.5, seed=1), NAME, NORM, False)
    found = prices(law)
    assert [each.error for each in found] == list(ERRORS)
    # The worse direction reached 10 / 800 = 1.25 %.
    assert [each.measured for each in found] == [True, True, False, False, False]
    # No smaller run than the first is offered.
    assert price(law, 0.5).cpu_seconds == pytest.approx(0.3 + law.time(1e4)[1].sum())
    assert np.all(np.diff([each.seconds for each in found]) > 0.0)
    assert found[-1].uncertainty > found[1].uncertainty > 0.0


def test_a_part_that_does_not_grow_does_not_bend_the_slope():
    law = fit(ladder(0.5, fixed=5.0), NAME, NORM, False)
    assert law.slope == pytest.approx(0.5)
    assert law.time(1e6)[1] == pytest.approx(5.0 + 0.1)


def test_no_prediction_is_made_with_less_than_the_slope_of_independent_replicates():
    law = fit(ladder(0.4), NAME, NORM, False)
    assert law.slope == pytest.approx(0.4)
    assert law.used_slope == 0.5


def test_the_stated_uncertainty_covers_the_truth():
    """Predictions from 200 noisy ladders: at least 0.55 within one stated error, where 0.68 are expected.

    The scatter is estimated from few runs, which takes some; a right program fails in 1e-4 of the cases.
    """
    truth = np.log(price(fit(ladder(0.5), NAME, NORM, True), 0.001).cpu_seconds)
    inside = 0
    for seed in range(200):
        found = price(fit(ladder(0.5, seed=seed), NAME, NORM, True), 0.001)
        inside += abs(np.log(found.cpu_seconds) - truth) < np.log1p(found.uncertainty)
    assert inside >= 110


def test_a_black_component_has_no_price_and_a_black_direction_none_either():
    dark = np.zeros(2)
    assert prices(fit(ladder(0.5), NAME, dark, True)) == []
    half = np.array([2.0, 0.0])
    lit = price(fit(ladder(0.5), NAME, half, True), 0.01)
    assert lit.cpu_seconds == pytest.approx(0.3 + 0.05 + 1e-7 * 1e6)


def test_a_run_that_met_no_light_is_left_out():
    rungs = ladder(0.5)
    rungs[0].noise[NAME][1] = 0.0
    law = fit(rungs, NAME, NORM, True)
    assert law.rungs == 3
    assert law.error(1e6) == pytest.approx([0.01, 0.005])


def test_a_single_run_makes_a_law_as_well():
    law = fit(ladder(0.5, rays=(1e4,)), NAME, NORM, False)
    assert (law.slope, law.slope_error) == (0.5, 0.0)
    assert law.time(2e4)[1] == pytest.approx(2.0 * (0.05 + 1e-3))


def test_runs_by_other_means_than_the_last_are_left_out():
    """A change of the estimator is no slope; of the two runs that remain none is fitted."""
    few, many = ladder(0.5, level=100.0)[:2], ladder(0.5)[2:]
    for rung in many:
        rung.estimators[NAME] = ["operator", "operator"]
    law = fit(few + many, NAME, NORM, False)
    assert (law.rungs, law.slope) == (2, 0.5)
    assert law.error(1e6) == pytest.approx([0.01, 0.005])


def test_no_lattice_is_trusted_beyond_its_steepest_slope():
    law = fit(ladder(1.4), NAME, NORM, False)
    assert law.slope == pytest.approx(1.4)
    assert law.used_slope == 1.0
