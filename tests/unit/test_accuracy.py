"""Accuracy in one number."""

import numpy as np
import pytest

from goniosim.accuracy import READINGS, bound, fall, norm, paths_for, relative_error
from goniosim.sums import Batches, Paths

SIZE = np.array([[0.5, 0.5, 0.0], [1.0, 1.0, 0.5]])
ENERGY = np.array([[[0.1, 0.2, 0.3], [0.4, 0.0, 0.1]], [[0.0] * 3] * 2])
ONE = np.array([0.5, 0.5])
TOTAL = (np.array([1.1, 0.0]), np.array([0.011, 0.0]))


def measured(of, stderr, energy=ENERGY, total=TOTAL):
    return relative_error(of, energy, stderr, total, SIZE, ONE)


@pytest.mark.parametrize("of", ["slice", "cells"])
def test_one_percent_everywhere_is_one_percent(of):
    assert measured(of, 0.01 * ENERGY) == pytest.approx(0.01)


def test_one_percent_of_the_sum_is_one_percent():
    assert measured("albedo", ENERGY) == pytest.approx(0.01)


@pytest.mark.parametrize("of", READINGS)
def test_of_what_was_not_seen_no_error_is_known(of):
    dark, none = np.zeros_like(ENERGY), (np.zeros(2), np.zeros(2))
    assert measured(of, dark, dark, none) == np.inf
    assert bound(of, dark, dark, none, SIZE, ONE, Paths(dark, 1000)) == np.inf
    assert bound(of, dark, dark, none, SIZE, ONE, Batches(dark, dark, np.zeros((32, 2, 2, 3))), 0.1) == np.inf


@pytest.mark.parametrize("of", READINGS)
def test_nor_of_what_is_too_faint_to_have_squares(of):
    """All replicates differ, and not one of their deviations has a square that is a number."""
    faint, total = 1e-165 * ENERGY, tuple(1e-165 * each for each in TOTAL)
    assert measured(of, 0.0 * faint, faint, total) == np.inf
    bright, dim = ENERGY[0], 1e-165 * ENERGY[0]
    both, totals = np.stack([bright, dim]), (np.array([1.1, 1.1e-165]), np.array([0.011, 0.0]))
    # Beside what is seen it does not count.
    assert measured(of, np.stack([0.01 * bright, 0.0 * dim]), both, totals) == pytest.approx(0.01)


def test_the_norm_weighs_cells_by_their_size_and_leaves_out_what_is_not_valid():
    assert norm(ENERGY, SIZE)[0] == pytest.approx(np.sqrt(0.01 / 0.5 + 0.04 / 0.5 + 0.16 + 0.01 / 0.5))


def test_channels_count_by_their_weights():
    energy, stderr = np.stack([ENERGY[0], ENERGY[0]]), np.stack([0.01 * ENERGY[0], 0.03 * ENERGY[0]])
    assert relative_error("slice", energy, stderr, None, SIZE, np.array([0.75, 0.25])) == pytest.approx(0.015)


def test_dim_cells_and_few_bad_ones_do_not_count():
    energy = np.ones((1, 1, 1000))
    energy[0, 0, 960:] = 1e-9
    stderr = 0.02 * energy
    stderr[0, 0, 960:] = 1.0
    stderr[0, 0, :30] = 1.0
    assert relative_error("cells", energy, stderr, None, np.ones((1, 1000)), np.ones(1)) == pytest.approx(0.02)


@pytest.mark.parametrize(("cells", "quantile"), [(1, 1.645), (4, 1.395), (10_000, 1.0091)])
def test_a_target_is_held_against_what_the_true_error_stays_below_in_nine_of_ten_runs(cells, quantile):
    """Of so many equal cells: roots of the 90 % quantiles of chi-square over its degrees of freedom."""
    energy, size = np.full((1, 1, cells), 1.0 / cells), np.ones((1, cells))
    stderr, total = 0.01 * energy, (np.ones(1), np.full(1, 0.01 / np.sqrt(cells)))
    # So many paths that what they share is nothing.
    noise = Paths(energy, 10**12)
    assert bound("slice", energy, stderr, total, size, np.ones(1), noise) == pytest.approx(0.01 * quantile, rel=0.02)
    assert bound("cells", energy, stderr, total, size, np.ones(1), noise) == pytest.approx(0.01)
    albedo = 0.01 * 1.645 / np.sqrt(cells)
    assert bound("albedo", energy, stderr, total, size, np.ones(1), noise) == pytest.approx(albedo, rel=0.02)


@pytest.mark.false_alarm(0)
def test_cells_that_share_their_noise_count_as_one():
    shared = np.random.default_rng(1).normal(1.0, 0.3, 32)
    energy = np.full((1, 10, 10), shared.mean() / 100.0)
    stderr = energy * shared.std(ddof=1) / np.sqrt(32) / shared.mean()
    noise = Batches(energy, stderr, np.broadcast_to(shared[:, None, None, None] / 100.0, (32, 1, 10, 10)))
    given = "slice", energy, stderr, (np.ones(1), np.zeros(1)), np.ones((10, 10)), np.ones(1)
    # The 95 % quantile of Student's t with 31 degrees of freedom.
    assert bound(*given, noise) == pytest.approx(1.696 * relative_error(*given), rel=0.02)
    assert bound(*given, None) == pytest.approx(1.645 * relative_error(*given), rel=0.02)


def test_what_nodes_may_be_off_by_counts_too():
    given = "cells", ENERGY, 0.03 * ENERGY, TOTAL, SIZE, np.array([1.0, 0.0])
    whole = norm(ENERGY, SIZE)[0]
    assert bound(*given, None, 0.04 * whole) == pytest.approx(0.05)


@pytest.mark.parametrize(
    ("noise", "independent", "slope"),
    [
        ([1.0, 0.5, 0.2], False, 0.66),
        ([1.0, 0.5, 0.2], True, 0.5),
        ([0.5], False, 0.5),
        ([1.0, 0.5, 0.45], False, 0.5),
        ([1.0, 0.5, 0.6], False, 0.5),
        ([1.0, 0.5, 0.01], False, 1.0),
    ],
)
def test_two_checkpoints_tell_how_a_noise_falls_within_bounds(noise, independent, slope):
    assert fall([10.0, 50.0, 200.0][: len(noise)], noise, independent) == pytest.approx(slope, abs=0.005)


def test_light_paths_that_a_target_takes():
    assert paths_for(0.01, 0.1, 0.0, 1000, 0.5) == pytest.approx(1e5)
    assert paths_for(0.01, 0.1, 0.0, 1000, 1.0) == pytest.approx(1e4)
    assert paths_for(0.01, 0.009, 0.0, 1000, 0.5) == 1000.0
    # Both have a part that no path takes away: noises of .08 and .008 then.
    assert paths_for(0.01, np.hypot(0.08, 0.006), 0.006, 1000, 0.5) == pytest.approx(1e5)
    assert paths_for(0.01, 0.1, 0.01, 1000, 0.5) == np.inf
    # A number, however far.
    assert 1e200 < paths_for(1e-200, 0.1, 0.0, 1000, 0.5) < np.inf
