"""Work on threads: order, stopping, and rounds until an accuracy is reached."""

import threading
import time

import pytest

from goniosim.engine.drive import Drive, Limit
from goniosim.engine.ordered import in_order
from goniosim.engine.outlook import Ahead


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


NEVER = 0


class Counted:
    """A run in which a direction is accurate after so many rounds; a ray of it takes so many seconds."""

    sides = (0,)

    def __init__(self, *needed, seconds=0.0):
        self.needed = needed
        self.seconds = seconds
        self.rounds = [0] * len(needed)
        self.asked = []

    @property
    def rays(self):
        return [100 * ((1 << rounds) - 1) for rounds in self.rounds]

    def rays_of_round(self, number):
        return 100 << number

    def round(self, number, directions):
        self.asked.append(tuple(directions))
        return [(number, m) for m in directions]


class Clock:
    """Stands still unless it is moved."""

    seconds = 0.0

    def perf_counter(self):
        return self.seconds


@pytest.fixture
def clock(monkeypatch):
    made = Clock()
    monkeypatch.setattr("goniosim.engine.drive.time", made)
    return made


def reach(runs, limit, stop=None, clock=None, instead=lambda run: None, given=None):
    """Whether all was reached; the order of the rounds, by number of the run and of the round."""
    clock = clock or Clock()
    drive = Drive(1, stop or threading.Event(), lambda done, total: None)
    order = []

    def do(run, works):
        order.append((runs.index(run), works[0][0]))
        began = clock.seconds
        for number, m in works:
            run.rounds[m] += 1
            clock.seconds += run.seconds * run.rays_of_round(number)
        return clock.seconds - began

    def judge(run, m):
        return None if run.needed[m] == NEVER else run.rounds[m] >= run.needed[m]

    return drive.reach(given or runs, judge, instead, limit, do), order


def test_easy_directions_stop_early():
    run = Counted(1, 3, 2)
    assert reach([run], Limit(None, None))[0] is True
    assert run.asked == [(0, 1, 2), (1, 2), (1,)]


def test_runs_take_turns_and_easy_ones_stop_early():
    easy, hard = Counted(1, 1), Counted(1, 4)
    assert reach([easy, hard], Limit(None, None)) == (True, [(0, 0), (1, 0), (1, 1), (1, 2), (1, 3)])
    assert hard.asked == [(0, 1), (1,), (1,), (1,)]


def test_what_can_never_be_reached_ends_by_itself():
    assert reach([Counted(NEVER, 3), Counted(1)], Limit(None, None)) == (False, [(0, 0), (1, 0), (0, 1), (0, 2)])


def test_another_run_takes_the_place_of_one_after_its_first_round():
    runs = [Counted(NEVER), Counted(2), Counted(2)]
    instead = {runs[0]: runs[2]}.get
    order = [(0, 0), (1, 0), (2, 0), (1, 1), (2, 1)]
    assert reach(runs, Limit(None, None), instead=instead, given=runs[:2]) == (True, order)


def test_limits_end_what_is_not_reached():
    assert reach([Counted(1, 9)], Limit(1500, None)) == (False, [(0, number) for number in range(4)])
    runs = [Counted(9), Counted(2), Counted(9)]
    assert reach(runs, Limit(700, None))[0] is False
    assert [run.rays for run in runs] == [[700], [300], [700]]


def test_every_run_has_its_first_round_within_any_time(clock):
    runs = [Counted(1, 9, seconds=1.0), Counted(9, seconds=1.0)]
    assert reach(runs, Limit(None, 1e-3), clock=clock) == (False, [(0, 0), (1, 0)])


def test_time_is_shared_and_what_is_too_short_for_one_run_serves_another(clock):
    runs = [Counted(9, seconds=1.0), Counted(9, seconds=0.1)]
    # Rounds take 100, 200, ... and 10, 20, ... seconds.
    order = [(0, 0), (1, 0), (0, 1), (1, 1), (1, 2), (1, 3), (1, 4)]
    assert reach(runs, Limit(None, 660.0), clock=clock) == (False, order)
    assert clock.seconds == pytest.approx(300.0 + 310.0)


def looking_ahead(error, rays):
    """An `Ahead` for which all directions take so many rays, and what it tells."""
    told = []
    return Ahead(lambda run, m: (error, rays), told.append), told


def test_a_target_out_of_reach_ends_what_nothing_limits(clock):
    """After the first round, of ten seconds, instead of three hundred years."""
    ahead, told = looking_ahead(0.1, 1e11)
    assert reach([Counted(9, seconds=0.1)], Limit(None, None, ahead=ahead), clock=clock) == (False, [(0, 0)])
    (outlook,) = told
    assert (outlook.error, outlook.paths, outlook.needed, outlook.is_cut) == (0.1, 100, 1e11, False)
    assert outlook.seconds == pytest.approx(1e10)
    # Whoever limits it wants what the limits give.
    ahead, told = looking_ahead(0.1, 1e11)
    found = reach([Counted(9, seconds=0.1)], Limit(1500, None, ahead=ahead), clock=clock)
    assert (found, [outlook.is_cut for outlook in told]) == ((False, [(0, number) for number in range(4)]), [True])


@pytest.mark.parametrize(
    ("rays", "most", "seconds", "told"),
    [
        # Ten seconds a round and 990 to come; a day to come.
        (10_000.0, None, None, []),
        (1e6, None, None, [False]),
        # Twice the limits, or less.
        (10_000.0, 6000, None, []),
        (10_000.0, 4000, None, [True]),
        (10_000.0, None, 600.0, []),
        (10_000.0, None, 400.0, [True]),
        # After the first round of an estimator nothing is known.
        (None, None, 400.0, []),
    ],
)
def test_what_takes_long_or_longer_than_its_limits_is_told_once(clock, rays, most, seconds, told):
    ahead, found = looking_ahead(0.1, rays)
    reach([Counted(5, seconds=0.1)], Limit(most, seconds, ahead=ahead), clock=clock)
    assert [outlook.is_cut for outlook in found] == told


def test_news_are_told_again(clock):
    """A forecast that falls to a fifth, and again; one that falls to a half is none."""
    later = iter([1e8, 5e7, 1e7, 1e7, 1e6, 1e6, 1e6])
    told = []
    ahead = Ahead(lambda run, m: (0.1, next(later)), told.append)
    reach([Counted(7, seconds=0.1)], Limit(None, None, ahead=ahead), clock=clock)
    assert [outlook.needed for outlook in told] == [1e8, 1e7, 1e6]


def test_a_stop_ends_what_is_not_reached():
    stop = threading.Event()
    stop.set()
    assert reach([Counted(1, 2)], Limit(None, None), stop) == (False, [])
