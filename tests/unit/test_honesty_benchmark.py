"""The benchmark of error bars: its arithmetic on made-up results, whose errors are right, or too small."""

import math

import numpy as np
import pytest
from scipy import stats

from benchmarks import honesty
from goniosim.sums import BATCHES, block_sums
from synthetic import make_result

NAME = "reflection/internal"
SEEDS = 12
SHAPE = (1, 30, 60)


def row_of(folder, stated=1.0, estimator="operator", dim=1.0, noise=0.1, seed=3):
    """A row of slices with an error of ``noise`` in every cell, of which ``stated`` times as much is told.

    The sums of the batches are those of independent cells; those of the last rows hold ``dim`` as much as the others.
    """
    rng = np.random.default_rng(seed)
    result = make_result((0.0,), ("grey",), *SHAPE[1:], components=(NAME,), estimator=estimator, rays=10**6)
    component, cells = result.components[NAME], result.cells
    truth = cells.projected_solid_angle[0] / math.pi
    truth[-6:] *= dim
    one = honesty.Slice(SEEDS, SHAPE, folder)
    component.uncertain[:] = False
    for _ in range(SEEDS):
        batches = truth * (1.0 + noise * math.sqrt(BATCHES) * rng.normal(size=(BATCHES, *SHAPE)))
        component.energy[0] = batches.mean(axis=0)
        component.stderr[0] = stated * batches.std(axis=0, ddof=1) / math.sqrt(BATCHES)
        if estimator != "analog":
            sums = block_sums(batches)
            component.batches = (sums.mean(axis=0) + stated * (sums - sums.mean(axis=0)))[None]
        one.add(result, NAME, 0)
    return one.row("made-up", NAME, 0.0, 10**6, cells, 0)


@pytest.mark.false_alarm(1e-2, seeds=(3, 103, 203, 303, 403))
def test_honest_bars_are_found_honest(tmp_path, seed):
    """1800 cells and 450 blocks by 12 seeds: a right table is off with a probability of about 1 %."""
    row = row_of(tmp_path, seed=seed)
    assert row.faults == [] and row.estimator == "operator"
    assert row.ratio[0] == pytest.approx(1.0, abs=0.05) and 0.0 < row.ratio[1] < 0.05
    for name in ("bright", "1e-3", "1e-4"):
        share, error = row.shares[name]
        assert share == pytest.approx(row.expected, abs=0.015) and 0.0 < error < 0.01
    assert math.isnan(row.shares["1e-6"][0]) and row.unsure == 0.0
    assert "honest" in honesty.line(row)


@pytest.mark.false_alarm(1e-12)
def test_bars_that_are_too_short_are_found(tmp_path):
    """Stated 20 % too small: the ratio is 1.56, to 0.6 % over many seeds, and a share 89 % at the most."""
    row = row_of(tmp_path, stated=0.8)
    assert row.faults == ["ratio", "bright", "1e-3", "1e-4", "1e-5"]
    assert row.ratio[0] == pytest.approx(1.0 / 0.64, rel=0.08)
    assert "OFF: ratio" in honesty.line(row)


@pytest.mark.false_alarm(1e-6, seeds=(3, 103))
def test_dim_blocks_are_a_group_of_their_own(tmp_path, seed):
    """Ninety of 450 blocks hold 1e-6 to 1e-5 of the energy each. Over many seeds their share scatters by 0.0095."""
    row = row_of(tmp_path, dim=3e-3, seed=seed)
    assert row.shares["1e-6"][0] == pytest.approx(row.expected, abs=0.05)


@pytest.mark.false_alarm(2e-4, seeds=(3, 103, 203))
def test_independent_paths_state_what_the_covariance_of_cells_leaves(tmp_path, seed):
    """Blocks of cells that scatter on their own are that of few paths less: here next to nothing.

    Over many seeds the share is 0.953 +- 0.0032.
    """
    row = row_of(tmp_path, estimator="analog", seed=seed)
    assert row.expected == pytest.approx(0.9545, abs=1e-4)
    assert row.shares["1e-3"][0] == pytest.approx(0.945, abs=0.02)


@pytest.mark.false_alarm(0.1, seeds=tuple(range(3, 13)))
def test_uncertain_cells_do_not_count(tmp_path, seed):
    """Of 32 batches a relative error of 32 % is that of ten: cells with 40 % say nothing, blocks of them do.

    Over many seeds the share is 0.013 below what is expected, and scatters by 0.010.
    """
    row = row_of(tmp_path, noise=0.4, seed=seed)
    assert math.isnan(row.shares["bright"][0]) and row.shares["1e-3"][0] == pytest.approx(row.expected, abs=0.03)
    assert row.unsure == 0.0


@pytest.mark.parametrize("freedom", [1, 3, 31, math.inf])
def test_the_share_of_students_t(freedom):
    assert honesty.within_two(freedom) == pytest.approx(1.0 - 2.0 * stats.t.sf(2.0, freedom), rel=1e-12)


def test_a_deviation_is_from_the_others():
    """Seeds 1, 2, 6 with variance 1 each: the last is 4.5 off, with the variance 1 + 1/2."""
    z = honesty.deviations(np.array([6.0]), np.ones(1), np.array([3.0]), np.array([3.0]), 3)
    assert z == pytest.approx([4.5 / math.sqrt(1.5)])


def test_a_single_cell_tells_little():
    """The seeds agree by chance: then the error is that of so few numbers."""
    share, error = honesty.share_told([np.zeros(2)] * 4, np.array([True, False]), 0.95)
    assert (share, error) == (1.0, pytest.approx(math.sqrt(0.95 * 0.05 / 4)))
    assert all(math.isnan(each) for each in honesty.share_told([np.zeros(2)] * 4, np.zeros(2, bool), 0.95))


@pytest.mark.parametrize(
    ("ratio", "bright", "faults"),
    [
        ((1.04, 0.001), (0.96, 0.001), []),
        ((1.06, 0.001), (0.95, 0.001), ["ratio"]),
        ((1.06, 0.03), (0.92, 0.001), ["bright"]),
        ((1.00, 0.001), (0.92, 0.02), []),
        ((1.00, 0.001), (math.nan, math.nan), []),
    ],
)
def test_a_row_is_held_against_its_bars(ratio, bright, faults):
    """By what is demanded, or by what the seeds leave open."""
    good = (0.946, 0.001)
    shares = {"bright": bright, "1e-3": good, "1e-4": good, "1e-5": (0.92, 0.001), "1e-6": (0.5, 0.001)}
    row = honesty.Row("a", NAME, "split", 30.0, 1, ratio, shares, 0.946, 0.0)
    assert row.faults == faults


def test_the_cases_are_stacks():
    assert all((honesty.STACKS / f"{name}.yaml").exists() for name in honesty.CASES)
