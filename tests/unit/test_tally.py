"""The tally: error bars count a path once, however many deposits it makes."""

import numpy as np
import pytest

from goniosim.engine.estimate import mean_and_error
from goniosim.engine.layout import WEIGHT
from goniosim.engine.tally import add_deposits, record_length


def _deposit(paths, cells, weights, n_cells):
    """Histogram of deposits; weights of shape (channels, n)."""
    channels = len(weights)
    histogram = np.zeros((n_cells, record_length(channels)))
    batch = np.zeros((WEIGHT + channels, len(paths)))
    batch[WEIGHT:] = weights
    add_deposits(histogram, np.asarray(paths, np.int64), np.asarray(cells, np.int32), batch, len(paths), channels)
    return histogram


@pytest.mark.parametrize("channels", [1, 2, 3, 5])
def test_several_deposits_of_a_path_count_as_one(channels):
    rng = np.random.default_rng(1)
    n_paths, n_cells = 400, 6
    paths = np.repeat(np.arange(n_paths), rng.integers(0, 9, n_paths))
    cells = rng.integers(0, n_cells, len(paths))
    order = np.lexsort((cells, paths))
    paths, cells = paths[order], cells[order]
    weights = rng.uniform(0, 1, (channels, len(paths)))
    histogram = _deposit(paths, cells, weights, n_cells)

    per_path = np.zeros((channels, n_paths, n_cells))
    for c in range(channels):
        np.add.at(per_path[c], (paths, cells), weights[c])
    assert np.allclose(histogram[:, :channels].T, per_path.sum(axis=1), rtol=1e-13)
    assert np.allclose(histogram[:, channels : 2 * channels].T, (per_path**2).sum(axis=1), rtol=1e-13)
    seen = np.zeros((n_paths, n_cells), bool)
    seen[paths, cells] = True
    assert (histogram[:, 2 * channels] == seen.sum(axis=0)).all()

    mean, error = mean_and_error(histogram[:, :channels].T, histogram[:, channels : 2 * channels].T, n_paths)
    assert np.allclose(mean, per_path.mean(axis=1), rtol=1e-13)
    assert np.allclose(error, per_path.std(axis=1, ddof=1) / np.sqrt(n_paths), rtol=1e-11)


def test_neighbouring_paths_in_one_cell_stay_apart():
    histogram = _deposit([0, 1, 2], [0, 0, 0], np.full((3, 3), 0.5), 1)
    assert histogram[0, :7].tolist() == [1.5, 1.5, 1.5, 0.75, 0.75, 0.75, 3.0]


def test_no_rays_means_no_energy_and_no_nan():
    mean, error = mean_and_error(np.zeros(3), np.zeros(3), 0)
    assert (mean == 0).all() and (error == 0).all()
