"""What a run still takes to a target, from its checkpoints."""

import math
from types import SimpleNamespace

import pytest

from goniosim.engine import outlook

TARGET = SimpleNamespace(of="slice", relative_error=0.01)


def run_of(*noise):
    """One of rounds of 100, 200, ... light paths, with their noises."""
    noted = [(100 * ((2 << k) - 1), 0.0, 0.0, {"transmission": each}) for k, each in enumerate(noise)]
    return SimpleNamespace(rays=[700], spending=SimpleNamespace(checkpoints=[noted]))


@pytest.fixture
def needed(monkeypatch):
    """As `outlook.needed`, of a run whose error is .1 and whose nodes are right."""
    monkeypatch.setattr(outlook.assembly, "worst_error", lambda *_: 0.1)
    monkeypatch.setattr(outlook.assembly, "floor", lambda *_: 0.0)

    def call(run, known=None):
        return outlook.needed(None, run, known or run, 0, TARGET)

    return call


def test_two_rounds_of_replicates_tell_how_their_noise_falls(needed):
    """A tenth of the noise: a hundred times the paths, or ten times those of a lattice."""
    assert needed(run_of(1.0, 1.0, 1.0)) == (0.1, pytest.approx(70_000.0))
    assert needed(run_of(4.0, 2.0, 0.1)) == (0.1, pytest.approx(7_000.0))


def test_a_single_round_of_replicates_tells_nothing(needed):
    assert needed(run_of(1.0)) == (0.1, None)


def test_of_what_was_not_seen_only_the_least_is_told(needed, monkeypatch):
    """A path seen at once would be an error of 100 %: 1 % takes a hundred times as many, of independent ones 10,000."""
    monkeypatch.setattr(outlook.assembly, "worst_error", lambda *_: math.inf)
    assert needed(run_of(0.0)) == (math.inf, None)
    assert needed(run_of(0.0, 0.0)) == (math.inf, pytest.approx(70_000.0))
    assert needed(run_of(), SimpleNamespace(rays=[1000])) == (math.inf, pytest.approx(1e7))


def test_what_goes_on_from_others_needs_no_rounds_of_its_own(needed):
    assert needed(run_of(), SimpleNamespace(rays=[1000])) == (0.1, pytest.approx(100_000.0))
