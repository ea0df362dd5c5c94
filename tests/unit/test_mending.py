"""Variances of cells with few hits come from their neighbours, all others stay."""

import math

import numpy as np
import pytest

from goniosim.engine.mending import mended
from goniosim.slices import PARAMETRIZATIONS

# Five rows and columns.
AROUND = (2, 2)


def _naive(mean, variance, reach):
    """Cell by cell."""
    rows, width = mean.shape
    result = variance.copy()
    for i in range(rows):
        for j in range(width):
            if mean[i, j] == 0.0 or variance[i, j] > (0.15 * mean[i, j]) ** 2:
                near = []
                for row in range(max(i - reach[0], 0), min(i + reach[0] + 1, rows)):
                    for column in range(j - reach[1], j + reach[1] + 1):
                        turned = column % (2 * width)
                        near.append(variance[row, turned if turned < width else 2 * width - 1 - turned])
                result[i, j] = np.mean(near)
    return result


@pytest.mark.parametrize("reach", [(2, 2), (0, 1)])
@pytest.mark.parametrize("rows, width", [(9, 12), (5, 5), (3, 2), (1, 1)])
def test_it_is_what_a_loop_over_cells_finds(rows, width, reach):
    rng = np.random.default_rng(1)
    mean = rng.random((2, 3, rows, width)) * (rng.random((2, 3, rows, width)) < 0.7)
    variance = rng.random(mean.shape) * 0.05
    before = variance.copy()
    found = mended(mean, variance, reach)
    np.testing.assert_array_equal(variance, before)
    for i in np.ndindex(2, 3):
        np.testing.assert_allclose(found[i], _naive(mean[i], variance[i], reach), rtol=1e-14)


def test_well_known_cells_keep_their_own():
    mean, variance = np.ones((6, 8)), np.full((6, 8), 0.01)
    variance[3, 3] = 1.0
    found = mended(mean, variance, AROUND)
    assert (found[variance < 1.0] == 0.01).all()
    assert found[3, 3] == pytest.approx((24 * 0.01 + 1.0) / 25)


def test_a_bright_cell_leaves_nothing_behind_in_those_beyond_its_neighbours():
    mean, variance = np.zeros((9, 9)), np.full((9, 9), 1e-40)
    variance[1, 1] = 1.0
    np.testing.assert_allclose(mended(mean, variance, AROUND)[4:, 4:], 1e-40, rtol=1e-14)


@pytest.mark.false_alarm(1e-12)
def test_total_variance_of_uniform_darkness_stays():
    """Few hits, at random: what is handed round is neither made nor lost, to 0.05 % over many seeds."""
    rng = np.random.default_rng(2)
    replicates = rng.poisson(0.02, (32, 90, 180)).astype(float)
    variance = replicates.var(axis=0, ddof=1) / 32
    found = mended(replicates.mean(axis=0), variance, AROUND)
    assert found.min() > 0.0
    # Rows at the edge count a little more or less: 1 %.
    assert found.sum() == pytest.approx(variance.sum(), rel=0.01)


@pytest.mark.false_alarm(1e-6, seeds=(3, 103))
@pytest.mark.parametrize("parametrization", PARAMETRIZATIONS)
def test_a_narrow_lobe_is_not_given_more_noise_than_it_has(parametrization, seed):
    """Few hits around the mirror direction, where cells of half slices grow fifteenfold from row to row.

    Norm of the noise, in which small cells count most, within 10 %: some 5 standard errors.
    """
    slices = PARAMETRIZATIONS[parametrization][1]
    theta = math.radians(30.0)
    size = slices.geometry(90, 360, theta)[2][:, :180]
    rows = np.arange(90)[:, None]
    tilt = (0.5 + rows) ** 2 * 1.9e-4 if parametrization == "half" else np.hypot(rows - 30, np.arange(180) - 179.5)
    lobe = 1.0 / (1.0 + (tilt / (1e-3 if parametrization == "half" else 10.0)) ** 2) ** 2
    energy = size * lobe
    hits = np.random.default_rng(seed).poisson(60_000 * energy / energy.sum(), (32, 90, 180))
    mean, variance = hits.mean(axis=0), hits.var(axis=0, ddof=1) / 32
    lit = size > 0.0
    found = (mended(mean, variance, slices.ALIKE)[lit] / size[lit]).sum()
    assert found == pytest.approx((variance[lit] / size[lit]).sum(), rel=0.1)
