"""Errors that know their noise, on made-up references whose true error is known.

The references have Poissonian hits, down to less than one per cell, as the simulation does.
"""

import numpy as np
import pytest

from goniosim.compare.measures import measure, rmse
from goniosim.result import Cells

ROWS, COLUMNS, SEEDS = 8, 12, 3000


def make_cells(directions, valid=None):
    edges = np.linspace(0.0, np.pi / 2.0, ROWS + 1)
    size = np.diff(np.sin(edges) ** 2)[:, None] * np.pi / COLUMNS * np.ones(COLUMNS)
    shape = (directions, ROWS, COLUMNS)
    return Cells(
        parametrization="classic",
        row_edges=np.degrees(edges),
        column_edges=np.linspace(0.0, 360.0, COLUMNS + 1),
        valid=np.ones(shape, bool) if valid is None else np.broadcast_to(valid, shape),
        solid_angle=np.ones(shape),
        projected_solid_angle=np.broadcast_to(size, shape),
    )


def make_reference(directions, hits, seed):
    """A mirror-symmetric truth, and noisy measurements of it with their standard errors."""
    rng = np.random.default_rng(seed)
    half = rng.uniform(0.2, 2.0, (1, ROWS, COLUMNS // 2))
    truth = np.concatenate([half, half[..., ::-1]], axis=-1)
    weight = truth / (hits * truth)
    n = rng.poisson(np.broadcast_to(hits * truth, (directions, 1, ROWS, COLUMNS)))
    return truth, n * weight, np.sqrt(n) * weight


@pytest.mark.parametrize("hits", [0.5, 20.0])
@pytest.mark.parametrize("error", [0.0, 0.1, 1.0])
def test_the_debiased_error_is_unbiased_and_its_stderr_honest(hits, error):
    """3000 measurements; two tests at 4.5 sigma each: false-alarm rate 7e-6 for a normal quantity.

    The scatter of a variance is that of a distribution with a kurtosis of at most 6.
    """
    truth, reference, stderr = make_reference(SEEDS, hits, seed=11)
    cells = make_cells(SEEDS)
    pattern = np.where(np.arange(COLUMNS) % 2 == 0, 1.0, -1.0) * error
    model = np.broadcast_to(truth + pattern, reference.shape)
    found = measure(model, reference, stderr, cells)
    debiased = (found.squared - found.noise)[:, 0]
    expected = float((cells.projected_solid_angle[0] * error**2).sum())
    sigma = debiased.std() / SEEDS**0.5
    assert abs(debiased.mean() - expected) < 4.5 * sigma
    assert found.variance.mean() == pytest.approx(debiased.var(), rel=4.5 * np.sqrt(5.0 / SEEDS))


def test_the_true_model_is_rarely_told_from_noise():
    """An exact model is called wrong in 2.3 % of the cases if the error is normal; the sum of squares of 96
    cells is skewed, which makes that up to 4 %. Band of 4 sigma: false-alarm rate 6e-5."""
    truth, reference, stderr = make_reference(SEEDS, 50.0, seed=5)
    found = measure(np.broadcast_to(truth, reference.shape), reference, stderr, make_cells(SEEDS))
    wrong = np.mean([rmse(found, m).significant for m in range(SEEDS)])
    assert 0.015 < wrong < 0.04 + 4.0 * (0.04 / SEEDS) ** 0.5


def test_the_stderr_of_the_rmse_is_honest():
    """Scatter of the RMSE over seeds against its stated error, to 4.5 sigma of a standard deviation."""
    truth, reference, stderr = make_reference(SEEDS, 50.0, seed=7)
    found = measure(np.broadcast_to(truth + 0.3, reference.shape), reference, stderr, make_cells(SEEDS))
    errors = [rmse(found, m) for m in range(SEEDS)]
    assert all(error.significant for error in errors)
    scatter = np.std([error.rmse for error in errors])
    stated = np.mean([error.stderr for error in errors])
    assert stated == pytest.approx(scatter, rel=4.5 * (0.5 / SEEDS) ** 0.5)


def test_all_directions_and_channels_are_combined_as_in_the_paper():
    """Root of the mean over directions, then the mean over channels."""
    cells = make_cells(2)
    reference = np.zeros((2, 3, ROWS, COLUMNS))
    levels = np.array([[1.0, 2.0, 3.0], [3.0, 4.0, 5.0]])
    found = measure(reference + levels[:, :, None, None], reference, reference, cells)
    size = cells.projected_solid_angle[0].sum()
    by_channel = np.sqrt(size * (levels**2).mean(axis=0))
    assert rmse(found).rmse == pytest.approx(by_channel.mean(), rel=1e-12)
    assert rmse(found, channel=1).raw == pytest.approx(by_channel[1], rel=1e-12)
    assert rmse(found, 1, 2).rmse == pytest.approx(5.0 * size**0.5, rel=1e-12)
    assert rmse(found).noise_floor == 0.0 and rmse(found).significant
    np.testing.assert_allclose(found.albedo_model, levels * size)


def test_cells_that_are_not_valid_do_not_count():
    valid = np.ones((ROWS, COLUMNS), bool)
    valid[-1] = False
    reference = np.zeros((1, 1, ROWS, COLUMNS))
    model = reference.copy()
    model[..., -1, :] = 1e6
    found = measure(model, reference, reference, make_cells(1, valid))
    assert rmse(found).raw == 0.0 and found.albedo_model[0, 0] == 0.0


def test_nothing_at_all_has_no_error_and_no_nan():
    nothing = np.zeros((1, 1, ROWS, COLUMNS))
    error = rmse(measure(nothing, nothing, nothing, make_cells(1)))
    assert (error.rmse, error.stderr, error.upper, error.significant) == (0.0, 0.0, 0.0, False)


def test_the_worst_cell_is_named():
    reference = np.zeros((1, 1, ROWS, COLUMNS))
    model = reference.copy()
    model[0, 0, 3, 5] = -2.0
    found = measure(model, reference, reference + 0.1, make_cells(1))
    assert (found.worst_row[0, 0], found.worst_column[0, 0]) == (3, 5)
    assert (found.worst_difference[0, 0], found.worst_stderr[0, 0]) == (-2.0, 0.1)
