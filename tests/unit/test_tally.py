"""The tally: sums, squares and counts of the paths that left into each cell."""

import numpy as np
import pytest

from goniosim.engine.estimate import mean_and_error
from goniosim.engine.layout import WEIGHT
from goniosim.engine.tally import add_deposits, empty_records, record_length


def _deposit(cells, weights, n_cells):
    """Histogram of deposits; weights of shape (channels, n)."""
    channels = len(weights)
    histogram = empty_records(n_cells, channels)
    batch = np.zeros((WEIGHT + channels, len(cells)))
    batch[WEIGHT:] = weights
    add_deposits(histogram, np.asarray(cells, np.int32), batch, len(cells), channels)
    return histogram


@pytest.mark.false_alarm(0)
@pytest.mark.parametrize("channels", [1, 2, 3, 5])
@pytest.mark.parametrize("n", [0, 1, 17, 400])
def test_every_deposit_is_a_path(channels, n):
    rng = np.random.default_rng(1)
    n_cells = 6
    cells = rng.integers(0, n_cells, n)
    weights = rng.uniform(0, 1, (channels, n))
    histogram = _deposit(cells, weights, n_cells)

    per_path = np.zeros((channels, n, n_cells))
    per_path[:, np.arange(n), cells] = weights
    assert np.allclose(histogram[:, :channels].T, per_path.sum(axis=1), rtol=1e-13)
    assert np.allclose(histogram[:, channels : 2 * channels].T, (per_path**2).sum(axis=1), rtol=1e-13)
    assert (histogram[:, 2 * channels] == np.bincount(cells, minlength=n_cells)).all()
    if n > 1:
        mean, error = mean_and_error(histogram[:, :channels].T, histogram[:, channels : 2 * channels].T, n)
        assert np.allclose(mean, per_path.mean(axis=1), rtol=1e-13)
        assert np.allclose(error, per_path.std(axis=1, ddof=1) / np.sqrt(n), rtol=1e-11)


def test_neighbouring_paths_in_one_cell_stay_apart():
    histogram = _deposit([0, 0, 0], np.full((3, 3), 0.5), 1)
    assert histogram[0, :7].tolist() == [1.5, 1.5, 1.5, 0.75, 0.75, 0.75, 3.0]


@pytest.mark.parametrize("channels", [1, 3, 5])
def test_a_record_has_cache_lines_of_its_own(channels):
    records = empty_records(10, channels)
    assert records.shape == (10, record_length(channels)) and not records.any()
    assert records.ctypes.data % 64 == 0 and records.strides[0] % 64 == 0 and records.flags.c_contiguous


def test_no_rays_means_no_energy_and_no_nan():
    mean, error = mean_and_error(np.zeros(3), np.zeros(3), 0)
    assert (mean == 0).all() and (error == 0).all()
