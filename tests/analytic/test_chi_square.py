"""The chi-square test accepts what is right and rejects what is slightly wrong."""

import numpy as np
import pytest

from reference.chi_square import chi_square

RAYS = 200_000
CELLS = 500
SHARE = np.linspace(0.01, 1.0, CELLS) ** 4
SHARE *= 0.9 / SHARE.sum()


def sample(seed, weights=(1.0,)):
    """Deposits of paths that carry one of the weights with equal probability."""
    rng = np.random.default_rng(seed)
    observed = np.zeros(CELLS)
    for weight in weights:
        counts = rng.multinomial(RAYS // len(weights), [*SHARE, 1.0 - SHARE.sum()])
        observed += weight * counts[:-1] / RAYS
    return observed


@pytest.mark.false_alarm(1e-2, seeds=(0, 1000, 2000, 3000, 4000))
def test_right_distribution_is_accepted(seed):
    """Each of 40 draws within 4 sigma, and their spread as expected: false alarm below 1 %."""
    sigmas = [chi_square(sample(seed + n), SHARE, SHARE, RAYS).sigmas for n in range(40)]
    assert np.abs(sigmas).max() < 4
    assert 0.6 < np.std(sigmas) < 1.4


@pytest.mark.false_alarm(1e-2, seeds=(0, 1000, 2000, 3000, 4000))
def test_unequal_weights_are_accepted(seed):
    """As above, with weights of 1 and 0.2: false alarm below 1 %."""
    mean, second = SHARE * 0.6, SHARE * 0.52
    sigmas = [chi_square(sample(seed + n, (1.0, 0.2)), mean, second, RAYS).sigmas for n in range(40)]
    assert np.abs(sigmas).max() < 4
    # Half of the paths of each weight are fixed, not drawn: the sums vary a little less.
    assert 0.6 < np.std(sigmas) < 1.4


@pytest.mark.false_alarm(1e-12)
def test_energy_shifted_by_five_percent_is_rejected():
    """By 12.6 +- 1.2 sigma over many seeds, 7 of these above the limit."""
    mean = SHARE * np.where(np.arange(CELLS) % 2, 1.05, 0.95)
    assert chi_square(sample(1), mean, mean, RAYS).sigmas > 4


@pytest.mark.false_alarm(1e-11)
def test_overestimated_variance_is_rejected():
    """One draw is 5.0 +- 0.9 sigma below what is expected; the mean of 40 lies 7 of its errors below the limit."""
    assert np.mean([chi_square(sample(seed), SHARE, SHARE * 1.5, RAYS).sigmas for seed in range(40)]) < -4


@pytest.mark.false_alarm(1e-12)
def test_no_sparse_cell_is_dropped():
    """A wrong energy in the sparsest cells must show although they are pooled: by 23.1 +- 0.6 sigma."""
    wrong = SHARE.copy()
    wrong[:100] *= 20.0
    assert chi_square(sample(1), wrong, wrong, RAYS).sigmas > 4
