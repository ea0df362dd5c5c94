"""What more accuracy would cost, told from the checkpoints of a run."""

import dataclasses

import numpy as np
import pytest

from goniosim.report.simulation.accuracy import accuracy_lines
from goniosim.report.simulation.cost import cost_lines
from goniosim.report.simulation.trend import trend
from synthetic import make_result

NAME = "reflection/internal"
FIXED, PER_RAY = 3.0, 1e-5


def result_of(rays, slope, estimator):
    """A result whose time is p + c N and whose noise is N^-s, in two directions alike."""
    result = make_result(components=("reflection/direct", NAME))
    rays = np.tile(np.asarray(rays, float), (2, 1))
    seconds = 0.5 * (FIXED + PER_RAY * rays)
    noise = {NAME: rays**-slope}
    result.cost = dataclasses.replace(result.cost, rays=rays, seconds=seconds, cpu_seconds=seconds, error=noise)
    result.components[NAME].estimator = [estimator] * 2
    return result


@pytest.mark.parametrize(("estimator", "slope"), [("operator", 0.75), ("split", 1.0), ("analog", 0.5)])
def test_what_does_not_grow_is_not_multiplied(estimator, slope):
    found = trend(result_of([1e5, 3e5, 7e5], slope, estimator), NAME)
    assert not found.is_bound and found.about == "about"
    for factor in (2.0, 3.0, 10.0):
        times = factor ** (1.0 / slope)
        assert found.rays_for(factor) == pytest.approx(times)
        assert found.seconds_for(factor) == pytest.approx(FIXED + PER_RAY * 7e5 * times)


def test_of_a_single_round_only_a_bound_is_told():
    result = result_of([1e5], 0.9, "operator")
    found = trend(result, NAME)
    assert found.is_bound and found.seconds_for(2.0) == pytest.approx(4.0 * (FIXED + PER_RAY * 1e5))
    assert "times better at most" in accuracy_lines(result)[-1]
    assert (
        "Half the noise takes 4 times the rays" in cost_lines(result)[-1] and "at most 16 s" in cost_lines(result)[-1]
    )


@pytest.mark.parametrize("slope", [0.2, 1.7])
def test_luck_of_two_checkpoints_is_not_believed(slope):
    """The noise of a few replicates says little of the slope; paths and lattices bound it."""
    assert trend(result_of([1e5, 3e5], slope, "split"), NAME).slope == (0.5 if slope < 0.5 else 1.0)


def test_independent_paths_have_a_known_slope():
    assert trend(result_of([1e5, 3e5], 0.9, "analog"), NAME).slope == 0.5
