"""Errors that know their noise, on made-up references whose true error is known.

The references have Poissonian hits, down to less than one per cell, as the simulation does.
"""

import numpy as np
import pytest

from goniosim.compare.counts import Counts
from goniosim.compare.measures import measure, rmse
from goniosim.engine.estimate import mean_and_error
from goniosim.result import Cells, Component

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


@pytest.mark.false_alarm(2e-5, seeds=(11, 111))
@pytest.mark.parametrize("hits", [0.5, 20.0])
@pytest.mark.parametrize("error", [0.0, 0.1, 1.0])
def test_the_debiased_error_is_unbiased_and_its_stderr_honest(hits, error, seed):
    """3000 measurements; two tests at 4.5 sigma each: false-alarm rate 2e-5.

    The scatter of a variance is that of a distribution with a kurtosis of at most 6.
    """
    truth, reference, stderr = make_reference(SEEDS, hits, seed)
    cells = make_cells(SEEDS)
    pattern = np.where(np.arange(COLUMNS) % 2 == 0, 1.0, -1.0) * error
    model = np.broadcast_to(truth + pattern, reference.shape)
    found = measure(model, reference, stderr, cells)
    debiased = (found.squared - found.noise)[:, 0]
    expected = float((cells.projected_solid_angle[0] * error**2).sum())
    sigma = debiased.std() / SEEDS**0.5
    assert abs(debiased.mean() - expected) < 4.5 * sigma
    assert found.variance.mean() == pytest.approx(debiased.var(), rel=4.5 * np.sqrt(5.0 / SEEDS))


@pytest.mark.false_alarm(6e-5, seeds=(5, 105, 205))
def test_the_true_model_is_rarely_told_from_noise(seed):
    """An exact model is called wrong in 2.3 % of the cases if the error is normal; the sum of squares of 96
    cells is skewed, which makes that up to 4 %. Band of 4 sigma: false-alarm rate 6e-5."""
    truth, reference, stderr = make_reference(SEEDS, 50.0, seed)
    found = measure(np.broadcast_to(truth, reference.shape), reference, stderr, make_cells(SEEDS))
    wrong = np.mean([rmse(found, m).significant for m in range(SEEDS)])
    assert 0.015 < wrong < 0.04 + 4.0 * (0.04 / SEEDS) ** 0.5


@pytest.mark.false_alarm(1e-5, seeds=(7, 107))
def test_the_stderr_of_the_rmse_is_honest(seed):
    """Scatter of the RMSE over seeds against its stated error, to 4.5 sigma of a standard deviation: 1e-5."""
    truth, reference, stderr = make_reference(SEEDS, 50.0, seed)
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


# --- few hits, and none ---


RAYS = 4000


def lobe():
    """Energies of a bright lobe on a dark ground, shape (ROWS, COLUMNS), that sum to 1; mirror-symmetric."""
    row, column = np.arange(ROWS)[:, None], np.arange(COLUMNS)
    size = make_cells(1).projected_solid_angle[0]
    energy = size * (np.exp(-(((row - 4) / 1.2) ** 2) - ((column - 5.5) / 1.2) ** 2) + 0.003)
    return energy / energy.sum()


def count_paths(energy, runs, seed, weight=1.0):
    """Runs of `RAYS` paths of a weight: BSDF, standard error, and counts; ``energy`` per cell of the reference."""
    cells = make_cells(runs)
    shares = np.append(energy.ravel() / weight, 1.0 - energy.sum() / weight)
    hits = np.random.default_rng(seed).multinomial(RAYS, shares, runs)[:, :-1].reshape(runs, ROWS, COLUMNS)
    mean, error = mean_and_error(hits * weight, hits * weight**2, RAYS)
    return (cells, *measured(cells, hits, mean[:, None], error[:, None]))


def measured(cells, hits, energy, stderr):
    """BSDF, standard error, and counts."""
    size = cells.projected_solid_angle[:, None]
    bsdf, bsdf_stderr = energy / size, stderr / size
    part = Component(energy, stderr, bsdf, bsdf_stderr, hits, estimator=["analog"] * len(hits))
    return bsdf, bsdf_stderr, Counts(part, np.full(len(hits), RAYS), np.zeros_like(bsdf))


def only(counts, m):
    """The counts of a single run."""
    part = counts.sampled
    arrays = (each[[m]] for each in (part.energy, part.stderr, part.bsdf, part.bsdf_stderr, part.hits))
    return Counts(Component(*arrays, estimator=["analog"]), counts.rays[[m]], counts.integrated[[m]])


def compared(model_energy, cells, bsdf, stderr, counts):
    model = np.broadcast_to(model_energy / cells.projected_solid_angle[0], bsdf.shape)
    return measure(model, bsdf, stderr, cells, counts)


@pytest.mark.false_alarm(1e-4, seeds=(17, 117, 217))
@pytest.mark.parametrize("weight", [1.0, 0.01])
@pytest.mark.parametrize("hits", [0.3, 1, 2.5, 5, 20, 100, 3000])
def test_the_true_model_is_rarely_told_from_few_hits(hits, weight, seed):
    """At most one true model in 20 is called wrong, whether three paths in ten runs hit anything or 3000 each.

    1500 runs; 4 sigma above 5 %: false-alarm rate 1e-4 at most. Without the limits on what goes unseen it
    was 79 % at 0.3 hits, 30 % at 5 and 8 % at 20.
    """
    truth = hits * weight / RAYS * lobe()
    found = compared(truth, *count_paths(truth, 1500, seed, weight))
    wrong = np.mean([rmse(found, m).significant for m in range(1500)])
    assert wrong < 0.05 + 4.0 * (0.05 / 1500) ** 0.5


@pytest.mark.false_alarm(1e-9)
@pytest.mark.parametrize(("hits", "factor"), [(100, 2.0), (100, 0.0), (3000, 1.2), (3000, 0.8)])
def test_a_wrong_model_is_caught_with_few_hits_and_with_many(hits, factor):
    """In at least 95 of 100 runs; all four were caught in each of 4000: with a miss in 1000, a false alarm in 1e-9."""
    truth = hits / RAYS * lobe()
    found = compared(factor * truth, *count_paths(truth, 100, seed=3))
    assert np.mean([rmse(found, m).significant for m in range(100)]) >= 0.95


@pytest.mark.false_alarm(3e-4, seeds=(23, 123, 223))
@pytest.mark.parametrize(
    ("hits", "confidence"), [(0.3, 0.977), (2.5, 0.977), (10, 0.977), (20, 0.94), (100, 0.94), (3000, 0.97)]
)
@pytest.mark.parametrize("factor", [0.0, 1.0, 2.0])
def test_the_error_lies_below_its_upper_limit(hits, confidence, factor, seed):
    """In 97.7 % of the cases with many hits, in somewhat less with some; 400 runs, less 4 sigma (binomial: 3e-4).

    The estimated variance is low where the estimated error is. Without what goes unseen it was 1 % at 0.3
    hits and a model that sees nothing, 38 % at 2.5 and 80 % at 10.
    """
    truth = hits / RAYS * lobe()
    cells, *measured = count_paths(truth, 400, seed)
    found = compared(factor * truth, cells, *measured)
    exact = float((((factor - 1.0) * truth) ** 2 / cells.projected_solid_angle[0]).sum()) ** 0.5
    below = np.mean([exact <= rmse(found, m).upper for m in range(400)])
    assert below > confidence - 4.0 * (confidence * (1.0 - confidence) / 400) ** 0.5


@pytest.mark.parametrize(("expected", "significant"), [(2.99, False), (3.01, True)])
def test_without_any_hit_the_rule_of_three_decides(expected, significant):
    nothing = count_paths(np.zeros((ROWS, COLUMNS)), 2, seed=1)
    found = compared(expected / RAYS * lobe(), *nothing)
    assert rmse(found, 0).significant == significant
    # Both directions together had twice as many rays.
    assert rmse(found).significant
    assert not rmse(compared(0.5 * 2.99 / RAYS * lobe(), *nothing)).significant
    assert rmse(found, 0).upper > rmse(found, 0).rmse > 0.0


def test_one_hit_does_not_excuse_a_model_that_expects_a_hundred():
    cells = make_cells(1)
    hits = np.zeros((1, ROWS, COLUMNS), int)
    hits[0, 2, 3] = 1
    bsdf, stderr, counts = measured(cells, hits, hits[:, None] / RAYS, hits[:, None] / RAYS)
    flat = cells.projected_solid_angle[0] / np.pi
    assert rmse(compared(100.0 / RAYS * flat, cells, bsdf, stderr, counts)).significant
    assert not rmse(compared(2.0 / RAYS * flat, cells, bsdf, stderr, counts)).significant


def test_what_goes_unseen_excuses_no_error_of_what_is_integrated():
    """A model that falls short of what is integrated is wrong; one that exceeds it may not be."""
    cells, nothing, stderr, counts = count_paths(np.zeros((ROWS, COLUMNS)), 1, seed=1)
    integrated = np.broadcast_to(lobe() / cells.projected_solid_angle[0], nothing.shape)
    counts = Counts(counts.sampled, counts.rays, integrated)
    error = 1.0 / RAYS * lobe()
    assert not rmse(compared(lobe() + error, cells, integrated, stderr, counts)).significant
    assert rmse(compared(lobe() - error, cells, integrated, stderr, counts)).significant


def test_the_albedo_of_what_nothing_hit_has_an_error_bar():
    found = compared(lobe(), *count_paths(np.zeros((ROWS, COLUMNS)), 1, seed=1))
    assert found.albedo_stderr[0, 0] == pytest.approx(1.5 / RAYS)


@pytest.mark.false_alarm(1.1e-4, seeds=(29, 129, 229))
@pytest.mark.parametrize("hits", [5, 100, 3000])
def test_no_cell_of_the_true_model_is_called_the_worst(hits, seed):
    """In at most one comparison of 20, however many cells are looked at: 600 runs, 4 sigma (binomial: 1.1e-4)."""
    truth = hits / RAYS * lobe()
    cells, bsdf, stderr, counts = count_paths(truth, 600, seed)
    named = []
    for m in range(600):
        one = only(counts, m)
        named.append(compared(truth, make_cells(1), bsdf[[m]], stderr[[m]], one).worst_excess.any())
    assert np.mean(named) < 0.05 + 4.0 * (0.05 / 600) ** 0.5


def test_the_worst_cell_is_a_significant_one_even_if_another_deviates_more_by_chance():
    truth = 3000 / RAYS * lobe()
    wrong = truth.copy()
    wrong[2, 9] += 60.0 / RAYS
    found = compared(wrong, *count_paths(truth, 20, seed=31))
    assert set(found.worst_row[:, 0]) == {2} and set(found.worst_column[:, 0]) == {9}


def test_a_cell_that_nothing_hit_is_the_worst_only_if_many_hits_were_due():
    """3 + log(96) = 7.6 of them for 96 cells."""
    measured = count_paths(np.zeros((ROWS, COLUMNS)), 1, seed=1)
    for due, row in ((7.0, -1), (8.0, 5)):
        model = np.zeros((ROWS, COLUMNS))
        model[5, 4] = due / RAYS
        found = compared(model, *measured)
        assert found.worst_row[0, 0] == row and (found.worst_excess[0, 0] > 0.0) == (row > 0)
