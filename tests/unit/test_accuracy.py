"""Accuracy in one number."""

import numpy as np
import pytest

from goniosim.accuracy import READINGS, norm, relative_error

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
def test_black_slices_are_sure(of):
    dark = np.zeros_like(ENERGY)
    assert measured(of, dark, dark, (np.zeros(2), np.zeros(2))) == 0.0


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
