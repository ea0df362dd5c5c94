"""The counter-based random numbers: uniform, uncorrelated, and different for every key."""

import numpy as np
import pytest
from scipy import stats

from goniosim._jit import kernel
from goniosim.engine.unit import unit_key
from goniosim.optics.random import derive_key, random_sincos, uniform


@kernel
def _draw(key, out):
    for i in range(out.shape[0]):
        out[i] = uniform(key, i)


@kernel
def _draw_azimuths(key, sine, cosine):
    for i in range(sine.shape[0]):
        sine[i], cosine[i] = random_sincos(key, i)


@kernel
def _derive(key, number):
    return derive_key(key, number)


def _numbers(key, n):
    out = np.empty(n)
    _draw(np.uint64(key), out)
    return out


@pytest.mark.false_alarm(2e-6, seeds=(7, 107))
def test_uniform_in_one_and_three_dimensions(seed):
    """Chi-square over 1000 intervals and over 10^3 boxes; false alarm 2e-6 in all."""
    u = _numbers(seed, 3_000_000)
    assert u.min() >= 0.0 and u.max() < 1.0
    counts = np.bincount((u * 1000).astype(int), minlength=1000)
    assert stats.chisquare(counts).pvalue > 1e-6
    box = (u.reshape(-1, 3) * 10).astype(int) @ [100, 10, 1]
    assert stats.chisquare(np.bincount(box, minlength=1000)).pvalue > 1e-6


@pytest.mark.false_alarm(2e-6, seeds=(11, 111))
def test_azimuths_are_uniform_on_the_circle(seed):
    """Chi-square over 1024 arcs and over 32^2 pairs of neighbours; false alarm 2e-6 in all."""
    sine, cosine = np.empty((2, 2_000_000))
    _draw_azimuths(np.uint64(seed), sine, cosine)
    assert np.abs(sine**2 + cosine**2 - 1.0).max() < 4e-15
    turns = (np.arctan2(sine, cosine) / (2.0 * np.pi)) % 1.0
    arcs = np.minimum((turns * 1024).astype(int), 1023)
    assert stats.chisquare(np.bincount(arcs, minlength=1024)).pvalue > 1e-6
    pairs = arcs[::2] // 32 * 32 + arcs[1::2] // 32
    assert stats.chisquare(np.bincount(pairs, minlength=1024)).pvalue > 1e-6


@pytest.mark.false_alarm(1.1e-4, seeds=(3, 103, 203))
def test_children_of_a_key_are_uncorrelated(seed):
    """Correlations between the streams of 20 sibling keys, 190 pairs; false alarm 190 * 5.7e-7."""
    n = 100_000
    streams = np.array([_numbers(_derive(np.uint64(seed), i), n) for i in range(20)])
    correlation = np.corrcoef(streams)[np.triu_indices(20, 1)]
    assert np.abs(correlation).max() < 5 / np.sqrt(n)


def test_keys_of_work_units_are_distinct():
    keys = {int(unit_key(seed, direction, unit)) for seed in range(20) for direction in range(20) for unit in range(50)}
    assert len(keys) == 20 * 20 * 50
