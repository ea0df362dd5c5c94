"""Numbers and tables as text."""

import numpy as np
import pytest

from goniosim.report import text
from goniosim.scene.quantity import percent


@pytest.mark.parametrize(
    ("value", "stderr", "shown"),
    [
        (0.0432178, 0.00002, "0.04322 ± 0.00002"),
        (0.0432178, 0.000014, "0.043218 ± 0.000014"),
        (0.0432178, 0.0000199, "0.04322 ± 0.00002"),
        (0.04, 0.0, "0.04000"),
        (0.04, 1e-12, "0.04000"),
        (0.00003576, 4e-9, "0.000035760 ± 0.000000004"),
        (0.0, 0.0, "0.00000"),
        (54.13, 0.31, "54.1 ± 0.3"),
        (54.13, 12.0, "54 ± 12"),
        (-6.1e-14, 1.04e-13, "(-0.6 ± 1.0)e-13"),
        (3.2e-11, 4e-12, "(3.2 ± 0.4)e-11"),
    ],
)
def test_the_error_decides_how_many_digits_a_value_has(value, stderr, shown):
    assert text.with_error(value, stderr) == shown


@pytest.mark.parametrize(
    ("number", "shown"),
    [(0, "0"), (100, "100"), (9999, "9999"), (10_000, "1e4"), (16_000_000, "1.6e7"), (1_234_567, "1.235e6")],
)
def test_counts_are_written_as_in_a_scene_file(number, shown):
    assert text.count(number) == shown


@pytest.mark.parametrize(
    ("seconds", "shown"),
    [
        (0.42, "0.42 s"),
        (59.4, "59 s"),
        (59.6, "1 min"),
        (200, "3 min 20 s"),
        (3600, "1 h"),
        (7500, "2 h 5 min"),
        (86_399, "23 h 59 min"),
        (100_000, "1 d 3 h"),
        (9e7, "1041 d 16 h"),
        (1e9, "32 years"),
        (1e15, "3.2e7 years"),
    ],
)
def test_durations_have_two_units_or_are_years(seconds, shown):
    assert text.duration(seconds) == shown


def test_sizes_and_rates_have_three_digits():
    assert text.size(12_345_678) == "12.3 MB"
    assert text.size(80) == "80 bytes"
    assert text.rate(11.83e6) == "11.8 M rays/s"
    assert text.rate(4.0, per="CPU-second") == "4 rays/CPU-second"


def test_columns_are_aligned_below_a_header_of_two_lines():
    lines = text.table(["theta", "lost:\nmasked"], [["0", "1.5"], ["60", "12.25"]])
    assert lines == [
        "           lost:",
        "  theta   masked",
        "      0      1.5",
        "     60    12.25",
    ]


def test_a_first_column_of_words_is_aligned_to_the_left():
    assert text.table(["name", "n"], [["M1", "1"], ["longer", "2"]])[1] == "  M1       1"


def test_channels_that_agree_everywhere_are_one_group():
    agree = np.array([[0.1, 0.2, 0.2], [0.3, 0.4, 0.4]])
    differ = np.array([[0.1, 0.2, 0.2], [0.3, 0.4, 0.5]])
    assert text.channel_groups(["R", "G", "B"], [agree]) == [("R", 0), ("GB", 1)]
    assert text.channel_groups(["R", "G", "B"], [agree, differ]) == [("R", 0), ("G", 1), ("B", 2)]
    assert text.channel_groups(["450 nm", "550 nm"], [np.ones((2, 2))]) == [("450 nm+550 nm", 0)]


@pytest.mark.parametrize(
    "share, digits, shown",
    [
        (0.0, 2, "0 %"),
        (3.14159e-6, 2, "0.00031 %"),
        (0.5, 2, "50 %"),
        (0.9949, 2, "99 %"),
        (0.9951, 2, "99.5 %"),
        (0.999, 2, "99.9 %"),
        (1.0, 2, "100 %"),
        (2.5, 2, "250 %"),
        (12.5, 3, "1250 %"),
        (0.25, 1, "25 %"),
        (4.44e-16, 1, "4e-14 %"),
        (1e6, 2, "1e+08 %"),
        (float("inf"), 2, "inf %"),
        (float("nan"), 2, "nan %"),
    ],
)
def test_percentages_have_no_exponent_where_people_read_them(share, digits, shown):
    assert percent(share, digits) == shown
