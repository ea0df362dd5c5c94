"""The score statistic accepts what is right, tells how wrong a parameter is, and keeps the promise of its power."""

import numpy as np
import pytest

from reference.score import pooled, score_of_paths, score_of_replicates

RAYS = 200_000
EDGES = np.linspace(0.0, 1.0, 41)
WEIGHTS = np.linspace(1.0, 0.2, 40)


def shares(parameter):
    """Probability of each cell: an exponential law that some paths leave at the end."""
    return np.diff(-np.exp(-EDGES * parameter))


MEAN, SECOND = WEIGHTS * shares(2.0), WEIGHTS**2 * shares(2.0)
SLOPE = WEIGHTS * (shares(2.0 * 1.0001) - shares(2.0)) / 0.0001


def sample(seed, parameter, rays=RAYS):
    """Energy of cells whose paths carry different weights."""
    probability = shares(parameter)
    counts = np.random.default_rng(seed).multinomial(rays, [*probability, 1.0 - probability.sum()])
    return WEIGHTS * counts[:-1] / rays


def scores(seed, parameter):
    replicates = np.array([sample([seed, number], parameter, RAYS // 50) for number in range(50)])
    return (
        score_of_paths(sample(seed, parameter), MEAN, SECOND, SLOPE, RAYS),
        score_of_replicates(replicates, MEAN, SECOND, SLOPE),
    )


@pytest.mark.false_alarm(2.1e-8)
def test_a_right_parameter_is_accepted():
    """100 scores of each kind: within their limits of 1e-10, and as wide as they say, to 6.2 sigma."""
    for kind in (0, 1):
        found = [scores(seed, 2.0)[kind] for seed in range(100)]
        assert all(each.right for each in found)
        # Student's t of 49 is wider than the normal distribution by 2 %.
        assert np.std([each.sigmas for each in found]) == pytest.approx((1.0, 1.02)[kind], abs=6.2 / np.sqrt(200.0))


@pytest.mark.false_alarm(0.02, seeds=(0, 100, 200, 300, 400, 500))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_error_of_the_promised_size_is_rejected(sign, seed):
    """Ten of each kind, of which one in a thousand would be accepted; and its size is told: 6.2 sigma of 10."""
    for kind in (0, 1):
        smallest = scores(seed, 2.0)[kind].smallest
        assert 0.01 < smallest < 0.05
        found = [scores(seed + number, 2.0 * (1.0 + sign * smallest))[kind] for number in range(10)]
        assert not any(each.right for each in found)
        told = np.mean([each.deviation for each in found])
        assert told == pytest.approx(sign * smallest, abs=0.05 * smallest + 6.2 * found[0].stderr / np.sqrt(10.0))


@pytest.mark.false_alarm(0)
def test_tests_of_one_parameter_add_up():
    """Four are twice as sharp as one."""
    found = [scores(seed, 2.0)[0] for seed in range(4)]
    assert pooled(found).stderr == pytest.approx(0.5 * found[0].stderr, rel=1e-9)
    assert pooled(found).deviation == pytest.approx(np.mean([each.deviation for each in found]), abs=1e-12)
