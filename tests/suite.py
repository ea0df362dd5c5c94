"""The suite as a whole: how many tests there are, and how often one of them fails by chance.

Both are judged when a run ends. Where tests run in workers, each of these collects everything, and the process that
started them nothing: it judges what one of them has told.
"""

import pytest

import alarms
import floor

# Chance that a right program fails any test: a run of `make test`, and what `make test-all` adds.
BARS = {"fast": 1e-6, "slow": 1e-4}

_NUMBERS = pytest.StashKey()
_COLLECTED = pytest.StashKey()


def kind_of(item):
    """Which command runs it."""
    return next((kind for kind in ("cluster", "slow") if item.get_closest_marker(kind)), "fast")


def alarm_faults(rates):
    """One line for each kind of which the rates add up to more than is allowed."""
    return [
        f"the false-alarm rates of all {kind} tests add up to {rates[kind]:.1e}, and may to {bar:.0e}: "
        "repeat those with the largest with other seeds (tests/alarms.py)"
        for kind, bar in BARS.items()
        if rates[kind] > bar
    ]


def is_whole(config):
    """Whether nothing but marks and names chooses among the tests."""
    narrowed = any(config.getoption(name, None) for name in ("ignore", "ignore_glob", "lf"))
    return config.args_source is config.ArgsSource.TESTPATHS and not narrowed


def faults(config):
    """What is wrong with the suite, as lines."""
    collected = config.stash.get(_COLLECTED, None)
    if collected is None or hasattr(config, "workeroutput"):
        return []
    said = floor.faults(collected["numbers"], floor.read()) if is_whole(config) else []
    return alarm_faults(collected["rates"]) + said


def pytest_addoption(parser):
    """`make floor` is this option."""
    parser.addoption("--write-floor", action="store_true", help="write the numbers of tests to tests/floor.txt")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Count before any are deselected."""
    kinds = [kind_of(item) for item in items]
    config.stash[_NUMBERS] = {kind: kinds.count(kind) for kind in floor.KINDS}


def pytest_collection_finish(session):
    """Add up the rates of what is left, and tell who started this worker."""
    # What does not import is told of as it is, and leaves nothing to count.
    if session.testsfailed:
        return
    rates = dict.fromkeys((*BARS, "cluster"), 0.0)
    for item in session.items:
        rates[kind_of(item)] += alarms.rate_of(item)
    config = session.config
    config.stash[_COLLECTED] = {"numbers": config.stash[_NUMBERS], "rates": rates}
    if hasattr(config, "workeroutput"):
        config.workeroutput["collected"] = config.stash[_COLLECTED]


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    """All workers tell the same; one that crashed tells nothing."""
    if told := getattr(node, "workeroutput", {}).get("collected"):
        node.config.stash[_COLLECTED] = told


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session):
    """Write the floor instead of running anything, if asked to."""
    if not session.config.getoption("--write-floor"):
        return None
    if not is_whole(session.config) or session.testsfailed:
        raise pytest.UsageError("--write-floor counts the whole suite: give no paths, and mend what does not import")
    floor.write(session.config.stash[_NUMBERS])
    return True


@pytest.hookimpl(tryfirst=True)
def pytest_sessionfinish(session, exitstatus):
    """A run that passed fails all the same if the suite is not what it was."""
    if exitstatus == pytest.ExitCode.OK and faults(session.config):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter, config):
    """One line of sums; one for each fault."""
    if collected := config.stash.get(_COLLECTED, None):
        sums = ", ".join(f"{collected['rates'][kind]:.1e} of {bar:.0e} ({kind})" for kind, bar in BARS.items())
        terminalreporter.write_line(f"false-alarm rates of the tests chosen: {sums}")
    for fault in faults(config):
        terminalreporter.write_line(f"FAILED: {fault}", red=True)
