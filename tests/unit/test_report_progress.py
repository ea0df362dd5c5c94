"""Progress: a bar, log lines, or nothing."""

import io

import pytest

from goniosim.report import progress


class Clock:
    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


class Closed(io.StringIO):
    """A terminal that has gone away."""

    def write(self, text):
        raise OSError(5, "Input/output error")


def _log(total=1000):
    clock, stream = Clock(), io.StringIO()
    return progress.LogLines(total, stream, clock), clock, stream


def test_log_lines_begin_after_five_seconds_and_get_rarer():
    log, clock, stream = _log()
    log.begin("metal")
    times = []
    for _ in range(600):
        clock.now += 1.0
        before = stream.getvalue()
        log.update(clock.now - 100.0, 1000)
        if stream.getvalue() != before:
            times.append(clock.now - 100.0)
    assert times == [5, 15, 35, 75, 135, 195, 255, 315, 375, 435, 495, 555]


def test_log_lines_tell_share_rate_and_time_left():
    log, clock, stream = _log(4_000_000)
    log.begin("metal")
    clock.now += 5.0
    log.update(1_000_000, 4_000_000)
    assert stream.getvalue().endswith("metal: 25 % of 4e6 rays, 200 k rays/s, about 15 s left\n")


def test_rays_that_were_there_before_say_nothing_of_speed():
    log, clock, stream = _log(4_000_000)
    log.begin("metal", inherited=1_000_000)
    log.update(1_000_000, 4_000_000)
    clock.now += 5.0
    log.update(2_000_000, 4_000_000)
    assert stream.getvalue().endswith("metal: 50 % of 4e6 rays, 200 k rays/s, about 10 s left\n")
    bar = progress.Bar(4_000_000, io.StringIO())
    bar.begin("metal", inherited=1_000_000)
    bar.update(2_000_000, 4_000_000)
    counted = bar._bar.format_dict
    assert (counted["n"], counted["initial"]) == (2_000_000, 1_000_000)


def test_rays_of_others_are_done_and_say_nothing_of_speed():
    log, clock, stream = _log(4_000_000)
    bar = progress.Bar(4_000_000, io.StringIO())
    for shown in (log, bar):
        shown.pass_over(2_000_000)
        # One of two was taken over.
        shown.pass_over(1_000_000)
        shown.begin("metal")
        clock.now += 5.0
        shown.update(1_000_000, 1_000_000)
    assert stream.getvalue().endswith("metal: 50 % of 4e6 rays, 200 k rays/s, about 10 s left\n")
    counted = bar._bar.format_dict
    assert (counted["n"], counted["initial"]) == (2_000_000, 1_000_000)
    # Where targets decide, nobody knows how many.
    log, _, _ = _log(None)
    log.pass_over(None)
    assert log.rays == 0


def test_log_lines_tell_rays_and_rate_where_a_target_decides():
    log, clock, stream = _log(None)
    log.begin("metal")
    clock.now += 5.0
    log.update(1_000_000, None)
    assert stream.getvalue().endswith("metal: 1e6 rays, 200 k rays/s\n")


def test_the_bar_tells_rays_and_rate_where_a_target_decides():
    stream = io.StringIO()
    bar = progress.Bar(None, stream)
    bar.begin("metal")
    bar.update(2_000_000, None)
    bar.close()
    last = stream.getvalue().rstrip().split("\r")[-1]
    assert last.startswith("metal: 2.00M rays [") and "rays/s]" in last and "%" not in last and "?" not in last


def test_log_lines_count_the_rays_of_earlier_materials():
    log, clock, stream = _log(200)
    log.begin("1/2 a")
    log.update(100, 100)
    log.begin("2/2 b")
    clock.now += 5.0
    log.update(50, 100)
    assert "2/2 b: 75 % of 200 rays" in stream.getvalue()


def test_nothing_done_yet_divides_nothing():
    log, clock, stream = _log()
    log.begin("metal")
    clock.now += 5.0
    log.update(0, 1000)
    assert stream.getvalue().endswith("metal: 0 % of 1000 rays\n")


def test_the_bar_shows_description_rays_and_rate():
    stream = io.StringIO()
    bar = progress.Bar(4_000_000, stream)
    bar.note("before")
    bar.begin("1/2 a")
    bar.update(2_000_000, 2_000_000)
    bar.begin("2/2 b")
    bar.note("between")
    bar.update(2_000_000, 2_000_000)
    bar.close()
    shown = stream.getvalue()
    assert "before" in shown
    assert "between" in shown
    last = shown.rstrip().split("\r")[-1]
    assert last.startswith("2/2 b: 100%|")
    assert "4.00M/4.00M rays [" in last
    assert "rays/s]" in last


@pytest.mark.parametrize("kind", [progress.Bar, progress.LogLines])
def test_a_terminal_that_goes_away_ends_nothing(kind):
    shown = kind(10, Closed())
    shown.note("one")
    shown.begin("metal")
    shown.update(5, 10)
    shown.note("two")
    shown.close()
    assert shown.stream is None


@pytest.mark.parametrize(
    ("quiet", "out", "err", "kind"),
    [
        (True, True, True, progress.Silent),
        (False, True, True, progress.Bar),
        (False, False, True, progress.LogLines),
        (False, True, False, progress.LogLines),
    ],
)
def test_a_bar_only_on_a_terminal(monkeypatch, quiet, out, err, kind):
    monkeypatch.setattr("sys.stdout.isatty", lambda: out, raising=False)
    monkeypatch.setattr("sys.stderr.isatty", lambda: err, raising=False)
    assert type(progress.make_progress(10, quiet)) is kind
