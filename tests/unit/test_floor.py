"""The stored numbers of tests: fewer fail the suite, and so do many more."""

import pytest

import floor

STORED = {"fast": 1000, "slow": 50}


@pytest.mark.parametrize(
    ("fast", "slow", "said"),
    [
        (1000, 50, []),
        (1020, 51, []),
        (999, 50, ["collected 999 fast tests, the floor in tests/floor.txt is 1000: some were lost; "]),
        (1021, 49, ["fast tests, the floor in tests/floor.txt is 1000, more than 2% below: `make floor`", "49 slow"]),
    ],
)
def test_the_floor_is_near_and_never_undercut(fast, slow, said):
    found = floor.faults({"fast": fast, "slow": slow}, STORED)
    assert len(found) == len(said)
    for line, words in zip(found, said, strict=True):
        assert words in line and "make floor" in line and "\n" not in line


def test_what_is_written_is_read(tmp_path):
    floor.write(STORED, tmp_path / "floor.txt")
    assert floor.read(tmp_path / "floor.txt") == STORED


def test_the_floor_of_this_suite_is_there():
    assert floor.read().keys() == set(floor.KINDS) and min(floor.read().values()) > 0
