"""False alarms: how often a right program fails a test by chance, and what is tried again before a test fails.

A test that judges random numbers carries the probability with which it fails although all is right. That is of no
account while bits stay as they are, for seeds are fixed; it is what a change of bits risks, in which all numbers are
drawn anew::

    @pytest.mark.false_alarm(1e-9)
    def test_one(): ...

    @pytest.mark.false_alarm(6e-4, seeds=(3, 103, 203))
    def test_other(seed): ...

The second draws all of its random numbers from ``seed``. It usually runs once, with the first. Where it fails, the next
one tells whether that was chance, and so on: it fails if it fails with all of them, which is as rare as the power says.
A program that is wrong by more than the limits fails with any seed, so that nothing is hidden. A rate of 0 is for what
looks like a test of random numbers and is none.
"""

import inspect

import pytest

NOTE = "tried again"


def seeds_of(item):
    """Seeds that a test is tried with, one after the other; none where it is not repeated."""
    mark = item.get_closest_marker("false_alarm")
    return () if mark is None else tuple(mark.kwargs.get("seeds", ()))


def rate_of(item):
    """Probability that a test fails by chance, with all of its seeds; 0 where it states none."""
    mark = item.get_closest_marker("false_alarm")
    return mark.args[0] ** max(1, len(seeds_of(item))) if mark and mark.args else 0.0


def fault_of(item):
    """What is wrong with the mark of a test, as a sentence, or nothing."""
    mark, seeds = item.get_closest_marker("false_alarm"), seeds_of(item)
    if mark is None:
        return ""
    if len(mark.args) != 1 or not 0.0 <= mark.args[0] < 1.0 or set(mark.kwargs) - {"seeds"}:
        return "false_alarm takes one probability, and seeds"
    if "seeds" in mark.kwargs and len(set(seeds)) < max(2, len(seeds)):
        return "seeds of false_alarm are two or more, and differ"
    # A fixture made of the seed would be that of the first one, when the test is tried again.
    stale = [name for name, made in item._fixtureinfo.name2fixturedefs.items() if "seed" in made[-1].argnames]
    if stale:
        return f"the fixture {stale[0]} takes seed; call a function instead, which is called again"
    if bool(seeds) != ("seed" in item.fixturenames):
        return "a test with seeds in its false_alarm takes seed, and no other one does"
    return ""


@pytest.fixture
def seed(request):
    """The first of the seeds in the mark `false_alarm`."""
    return (*seeds_of(request.node), None)[0]


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """Refuse a mark that does not say what it should."""
    if fault := fault_of(item):
        pytest.fail(f"{item.nodeid}: {fault} (tests/alarms.py)", pytrace=False)


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    """Call a repeated test until it passes, with all of its seeds but the last, which is left to pytest."""
    names = inspect.signature(pyfuncitem.obj).parameters
    for number in seeds_of(pyfuncitem)[:-1]:
        pyfuncitem.funcargs["seed"] = number
        try:
            pyfuncitem.obj(**{name: pyfuncitem.funcargs[name] for name in names})
            return True
        except AssertionError as error:
            first = (str(error).splitlines() or ["assert"])[0][:100]
            pyfuncitem.user_properties.append((NOTE, f"failed with seed {number}: {first}"))
        pyfuncitem.funcargs["seed"] = seeds_of(pyfuncitem)[-1]
    return None


@pytest.hookimpl(tryfirst=True)
def pytest_terminal_summary(terminalreporter):
    """Name what was tried again: more than one in a thousand runs is no chance."""
    for outcome in ("passed", "failed"):
        for report in terminalreporter.getreports(outcome):
            for name, text in report.user_properties:
                if name == NOTE and report.when == "call":
                    terminalreporter.write_line(f"{NOTE}, and {outcome}: {report.nodeid} {text}")
