"""Work on threads: order, stopping, and rounds until an accuracy is reached."""

import threading
import time

import pytest

from goniosim.engine.drive import Drive, Limit
from goniosim.engine.ordered import in_order


def ordered(works, threads=3, stop=None, work=None):
    """What `in_order` reduced, in its order."""
    found = []

    def slow_when_early(one, buffer):
        time.sleep(0.002 * (7 - one % 7))
        return 10 * one

    stop = stop or threading.Event()
    in_order(
        works,
        work or slow_when_early,
        [object() for _ in range(threads + 2)],
        lambda one, outcome, buffer: found.append((one, outcome)),
        threads,
        stop,
        lambda: None,
    )
    return found


@pytest.mark.parametrize("threads", [1, 3])
def test_outcomes_come_in_order(threads):
    assert ordered(range(20), threads) == [(i, 10 * i) for i in range(20)]


def test_nothing_is_begun_after_a_stop():
    stop = threading.Event()

    def work(one, buffer):
        if one == 4:
            stop.set()
        return one

    assert 5 <= len(ordered(range(1000), 2, stop, work)) < 20


def test_an_error_ends_all():
    stop = threading.Event()

    def work(one, buffer):
        if one == 3:
            raise ZeroDivisionError
        return one

    with pytest.raises(ZeroDivisionError):
        ordered(range(1000), 2, stop, work)
    assert stop.is_set()


class Counted:
    """A run in which a direction is accurate after so many rounds."""

    def __init__(self, needed):
        self.needed = needed
        self.rounds = [0] * len(needed)
        self.asked = []

    @property
    def rays(self):
        return [100 * ((1 << rounds) - 1) for rounds in self.rounds]

    gathered = True

    def rays_of_round(self, number):
        return 100 << number

    def round(self, number, directions):
        self.asked.append(tuple(directions))
        return []

    def reached(self, _, direction):
        self.rounds[direction] += 1
        return self.rounds[direction] >= self.needed[direction]


def reach(run, limit, stop=None):
    drive = Drive(1, stop or threading.Event(), lambda done, total: None)
    return drive.reach(run, list(range(len(run.needed))), run.reached, limit, None)


def test_easy_directions_stop_early():
    run = Counted([1, 3, 2])
    assert reach(run, Limit(None, None)) == []
    assert run.asked == [(0, 1, 2), (1, 2), (1,)]


def test_limits_end_what_is_not_reached():
    assert reach(Counted([1, 9]), Limit(1500, None)) == [1]
    run = Counted([9])
    reach(run, Limit(1500, None))
    assert run.rays[0] == 1500
    assert reach(Counted([1, 9]), Limit(None, 0.0)) == [1]


def test_a_stop_ends_what_is_not_reached():
    stop = threading.Event()
    stop.set()
    run = Counted([1, 2])
    assert reach(run, Limit(None, None), stop) == [0, 1] and run.asked == []
