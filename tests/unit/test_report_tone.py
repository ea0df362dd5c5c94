"""Brightness, false-colour levels and ticks."""

import numpy as np
import pytest

from goniosim.report.drawing import tone


def test_remapping_is_that_of_the_paper():
    assert tone.remap(np.array([-1.0, 0.0, 1.0, 100.0])) == pytest.approx([0.0, 0.0, np.log(2.0), np.log(11.0)])


def test_full_scale_is_a_quantile_that_few_pixels_exceed():
    f = np.linspace(0.0, 1.0, 10_001)[:, None]
    assert tone.white_point(f) == pytest.approx(1.0 - tone.OVEREXPOSED, rel=1e-3)


def test_a_peak_narrower_than_the_quantile_still_sets_a_scale():
    f = np.zeros((10_000, 3))
    f[0] = 1e4
    assert tone.remap(tone.white_point(f)) == pytest.approx(tone.FAINTEST_WHITE * tone.remap(1e4))


def test_a_black_slice_has_a_scale_too():
    assert tone.white_point(np.zeros((10, 3))) == 1.0


def test_exposure_maps_full_scale_to_one_and_clips():
    assert tone.exposed(np.array([[0.0, 2.0, 9.0]]), 2.0).tolist() == [[0.0, 1.0, 1.0]]


def test_other_than_three_channels_are_grey():
    assert tone.rgb(np.array([[1.0, 3.0]])).tolist() == [[2.0, 2.0, 2.0]]
    assert tone.luminance(np.array([1.0, 1.0, 1.0])) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("low", "high"), [(0.1, 0.1), (0.09, 0.11), (0.02, 0.13), (1e-3, 3.0), (1e-7, 1e5), (311.7, 311.7)]
)
def test_levels_are_few_round_ascending_and_near_the_range(low, high):
    levels = tone.levels(low, high)
    assert 1 <= len(levels) <= 12
    assert np.all(np.diff(levels) > 0.0)
    assert levels[0] > 0.0
    assert levels[-1] <= 1.3 * high
    # Three digits at most.
    assert all(len(f"{level:.9e}".split("e")[0].rstrip("0")) <= 4 for level in levels)


@pytest.mark.parametrize("high", [1e-4, 0.0731, 1.0, 37.0, 2e5])
def test_ticks_are_not_crowded(high):
    ticks = np.array(tone.axis_ticks(high, 0.09))
    places = tone.remap(ticks) / tone.remap(high)
    assert ticks[0] == 0.0
    assert ticks[-1] <= high
    assert 4 <= len(ticks) <= 12
    assert np.min(np.diff(places)) >= 0.09


@pytest.mark.parametrize(
    ("value", "shown"), [(0.0, "0"), (0.05, "0.05"), (200.0, "200"), (1e5, "1e5"), (2.5e-4, "2.5e-4")]
)
def test_labels_are_short(value, shown):
    assert tone.label(value) == shown
