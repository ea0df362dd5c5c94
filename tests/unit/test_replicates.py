"""Sums over replicates: what they must equal, and which rounds count."""

import numpy as np
import pytest

from goniosim.engine.estimators.split import Split
from goniosim.engine.layout import UP
from goniosim.engine.plan import make_plan
from goniosim.engine.replicated import ReplicatedRun
from goniosim.engine.replicates import Replicates, unfold
from goniosim.engine.rounds import FEWEST_PATHS, REPLICATES, SMALLEST, chunks, sizes
from goniosim.engine.welford import FoldedBlocks, Welford
from goniosim.sums import block_sums
from reference.scenes import dielectric, lambert, make_scene

SHAPE = (2, 7, 5)
VIEWS = [slice(0, 3), slice(0, 1), slice(1, 2), slice(2, 3)]


def replicates(count, seed):
    """Made-up energies [replicate, slot, channel, row, folded column]; no cell is sure."""
    return np.random.default_rng(seed).gamma(0.5, size=(count, 3, *SHAPE))


def added(rounds, columns=10):
    """Sums over rounds of (size, replicates)."""
    sums = Replicates(VIEWS, SHAPE, columns, alike=None)
    for size, found in rounds:
        for number, slots in enumerate(found):
            sums.add(number, size, slots)
        sums.finish_round()
    return sums


@pytest.mark.parametrize("smallest", [SMALLEST, 3 * SMALLEST])
@pytest.mark.parametrize("paths", [1, 1000, FEWEST_PATHS, 3 * FEWEST_PATHS, 10**7, 10**9 + 1])
def test_sizes_double_and_add_up(paths, smallest):
    found = sizes(paths, smallest)
    total = REPLICATES * sum(found)
    assert paths <= total < paths + REPLICATES * 2 ** len(found) or total == REPLICATES * smallest > paths
    assert all(b == 2 * a for a, b in zip(found, found[1:], strict=False))
    assert (len(found) == 1 and paths < FEWEST_PATHS) or found[0] >= smallest


@pytest.mark.parametrize("chunk", [1, 3, 8, 32, 50])
def test_every_replicate_is_in_one_chunk(chunk):
    pieces = chunks(chunk)
    assert [number for piece in pieces for number in piece] == list(range(REPLICATES))
    assert max(map(len, pieces)) <= chunk


@pytest.mark.false_alarm(0)
def test_one_round_is_the_mean_and_the_scatter():
    found = replicates(REPLICATES, 1)
    energy, stderr = added([(100, found)]).slices(0)
    whole = found.sum(axis=1)
    assert np.allclose(energy, unfold(whole.mean(axis=0), 10))
    assert np.allclose(stderr, unfold(whole.std(axis=0, ddof=1) / np.sqrt(REPLICATES), 10))


@pytest.mark.false_alarm(0)
def test_rounds_are_weighed_by_their_sizes():
    first, second = replicates(REPLICATES, 1), replicates(REPLICATES, 2)
    sums = added([(100, first), (200, second)])
    for view, slots in enumerate(VIEWS):
        (a, b) = (each[:, slots].sum(axis=1) for each in (first, second))
        mean = (a.mean(axis=0) + 2.0 * b.mean(axis=0)) / 3.0
        variance = (a.var(axis=0, ddof=1) + 4.0 * b.var(axis=0, ddof=1)) / 9.0 / REPLICATES
        assert np.allclose(sums.slices(view)[0], unfold(mean, 10))
        assert np.allclose(sums.slices(view)[1], unfold(np.sqrt(variance), 10))
    assert sums.paths == 300 * REPLICATES


def test_sums_over_cells_keep_what_cells_share():
    common = np.random.default_rng(3).gamma(2.0, size=(REPLICATES, 1, 1, 1, 1)) * np.ones((1, 3, *SHAPE))
    sums = added([(100, common)])
    # All cells move together: errors add up, not their squares.
    assert np.allclose(sums.total_stderr(0), sums.slices(0)[1].sum(axis=(1, 2)))


def test_batches_are_the_replicates_of_all_rounds():
    first, second = replicates(REPLICATES, 1), replicates(REPLICATES, 2)
    sums = added([(100, first), (200, second)])
    # No more rows or columns than blocks: each cell is one.
    assert np.allclose(sums.batches(0), unfold((first + 2.0 * second).sum(axis=1) / 3.0, 10))


def test_an_interrupted_round_counts_if_it_is_worth_it():
    whole, few, more = replicates(REPLICATES, 1), replicates(3, 2), replicates(9, 3)
    one = added([(100, whole)])
    assert np.array_equal(added([(100, whole), (200, few)]).slices(0)[0], one.slices(0)[0])
    both = added([(100, whole), (200, more)])
    assert both.paths == 100 * REPLICATES + 200 * 9 and both.count == REPLICATES + 9
    assert np.allclose(both.batches(0).mean(axis=0), both.slices(0)[0])
    assert added([(100, few)]).paths == 300 and added([(100, few[:1])]).paths == 0


def test_what_follows_a_gap_does_not_count():
    found = replicates(REPLICATES, 1)
    sums = Replicates(VIEWS, SHAPE, 10, alike=None)
    for number in (0, 1, 2, 4, 5):
        sums.add(number, 100, found[number])
    sums.finish_round()
    assert np.allclose(sums.slices(0)[0], unfold(found[:3].sum(axis=1).mean(axis=0), 10))


def test_nothing_scatters_where_nothing_is():
    sums = Welford()
    for _ in range(4):
        sums.add(np.array([0.0, 2.0]))
    assert sums.mean.tolist() == [0.0, 2.0] and sums.variance_of_mean().tolist() == [0.0, 0.0]


@pytest.mark.parametrize(("rows", "columns"), [(90, 360), (17, 38), (3, 4), (7, 5), (16, 37)])
def test_blocks_of_folded_slices(rows, columns):
    width = columns // 2 if columns % 2 == 0 else columns
    half = np.random.default_rng(1).gamma(0.5, size=(2, 3, rows, width))
    found = FoldedBlocks(rows, columns, width)(half)
    np.testing.assert_allclose(found, block_sums(unfold(half, columns)), rtol=1e-13)


def test_every_replicate_has_a_key_of_its_own():
    """Over directions, rounds, replicates, and runs of another seed."""
    plan = make_plan(make_scene([dielectric(1.5), lambert(0.5)], [0.0, 60.0], rows=2, columns=4))
    runs = [ReplicatedRun(plan, Split(plan, (UP,)), (UP,), seed) for seed in (1, 2)]
    works = [work for works in runs[0].rounds(3 * FEWEST_PATHS) for work in works]
    keys = [int(run._key_of(work, number)) for run in runs for work in works for number in work.replicates]
    assert {work.number for work in works} == {0, 1}
    assert len(set(keys)) == len(keys) == 2 * 2 * 2 * REPLICATES
