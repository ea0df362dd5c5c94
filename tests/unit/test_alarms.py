"""Tests that are tried again, and suites that are judged as a whole: by suites of a few lines."""

import pytest

import floor
import suite

pytest_plugins = ("pytester",)
pytestmark = pytest.mark.false_alarm(0)

HEAD = "import pytest\n"
LUCKY = """
@pytest.mark.false_alarm(1e-4, seeds=(1, 2, 3))
def test_lucky(seed):
    assert seed > 1, "too far off"
"""


@pytest.fixture
def run(pytester, monkeypatch):
    """Run a suite of that text, with this one's plugins; the floor is of one test."""
    monkeypatch.setattr(floor, "FILE", pytester.path / "floor.txt")
    monkeypatch.setattr(floor.read, "__defaults__", (floor.FILE,))
    monkeypatch.setattr(floor.write, "__defaults__", (floor.FILE,))
    floor.write({"fast": 1, "slow": 0})
    markers = ["slow", "cluster", "false_alarm(rate, seeds=None)"]
    pytester.makepyprojecttoml(
        f"[tool.pytest.ini_options]\ntestpaths = ['.']\naddopts = '--strict-markers'\nmarkers = {markers}\n"
    )
    pytester.makeconftest("pytest_plugins = ('alarms', 'suite')")

    def go(text, *options):
        pytester.makepyfile(test_few=HEAD + text)
        return pytester.runpytest_inprocess(*options)

    return go


def test_one_that_fails_with_some_seeds_passes_and_is_told_of(run):
    found = run(LUCKY)
    found.assert_outcomes(passed=1)
    assert found.ret == 0
    found.stdout.fnmatch_lines(
        [
            "tried again, and passed: test_few.py::test_lucky failed with seed 1: too far off*",
            "false-alarm rates of the tests chosen: 1.0e-12 of 1e-06 (fast), 0.0e+00 of 1e-04 (slow)",
        ]
    )


def test_one_that_fails_with_all_seeds_fails(run):
    found = run(LUCKY.replace("> 1", "> 3"))
    found.assert_outcomes(failed=1)
    found.stdout.fnmatch_lines(["E * assert 3 > 3", "tried again, and failed: * failed with seed 2: too far off*"])


def test_it_is_called_once_where_it_passes_and_what_is_no_assertion_is_no_chance(run):
    found = run(LUCKY.replace("seed > 1", "seed == 1"), "-rP")
    found.assert_outcomes(passed=1)
    found.stdout.no_fnmatch_line("*tried again*")
    found = run(LUCKY.replace('assert seed > 1, "too far off"', "if seed == 1: raise KeyError"))
    found.assert_outcomes(failed=1)
    found.stdout.no_fnmatch_line("*tried again*")


def test_parameters_and_fixtures_are_there_each_time(run):
    found = run(
        """
        @pytest.mark.false_alarm(1e-4, seeds=(1, 2))
        @pytest.mark.parametrize("number", [5, 6])
        def test_it(number, seed, tmp_path):
            assert tmp_path.exists() and number in (5, 6) and seed == 2
        """.replace("\n        ", "\n"),
        "test_few.py",
    )
    found.assert_outcomes(passed=2)
    found.stdout.fnmatch_lines(["*rates of the tests chosen: 2.0e-08 of*"])


@pytest.mark.parametrize(
    ("mark", "words"),
    [
        ("()", "takes one probability"),
        ("(5.0)", "takes one probability"),
        ("(1e-4, seed=3)", "takes one probability"),
        ("(1e-4, seeds=(3,))", "two or more, and differ"),
        ("(1e-4, seeds=(3, 3))", "two or more, and differ"),
        ("(1e-4)", "takes seed, and no other one does"),
    ],
)
def test_marks_that_say_nothing_sound_are_refused(run, mark, words):
    found = run(f"@pytest.mark.false_alarm{mark}\ndef test_it(seed): pass", "test_few.py")
    assert found.ret != 0 and words in found.stdout.str()


def test_a_fixture_made_of_the_seed_is_refused(run):
    """It would be that of the first seed when the test is tried again."""
    fixture = "@pytest.fixture\ndef made(seed): return seed\n"
    found = run(fixture + LUCKY.replace("(seed)", "(seed, made)"))
    found.assert_outcomes(errors=1)
    found.stdout.fnmatch_lines(["*the fixture made takes seed; call a function instead*"])


COMMON = "@pytest.mark.false_alarm({})\ndef test_one(): pass\n"


def test_rates_that_add_up_to_too_much_fail_a_run_that_passes(run):
    found = run(COMMON.format("1.1e-6"))
    found.assert_outcomes(passed=1)
    assert found.ret == 1
    found.stdout.fnmatch_lines(
        ["FAILED: the false-alarm rates of all fast tests add up to 1.1e-06, and may to 1e-06:*"]
    )


def test_slow_tests_have_a_bar_of_their_own_and_what_is_not_chosen_does_not_count(run):
    slow = COMMON.format("2e-4").replace("def", "@pytest.mark.slow\ndef")
    floor.write({"fast": 0, "slow": 1})
    assert run(slow).ret == 1
    assert run(slow, "-m", "not slow").ret == pytest.ExitCode.NO_TESTS_COLLECTED
    assert run(slow.replace("2e-4", "1e-5")).ret == 0


def test_fewer_tests_than_stored_fail_the_whole_suite_and_no_part_of_it(run):
    floor.write({"fast": 2, "slow": 0})
    whole = run("def test_one(): pass")
    assert whole.ret == 1
    whole.stdout.fnmatch_lines(["FAILED: collected 1 fast tests, the floor in tests/floor.txt is 2: some were lost*"])
    for options in (("test_few.py",), ("--ignore=x",)):
        assert run("def test_one(): pass", *options).ret == 0
    # Those that are deselected are there.
    assert run("def test_one(): pass\ndef test_two(): pass", "-k", "one").ret == 0


def test_the_floor_is_written_instead_of_running(run):
    found = run("def test_one(): assert False\n@pytest.mark.slow\ndef test_two(): pass", "--write-floor")
    assert found.ret == 0 and floor.read() == {"fast": 1, "slow": 1}
    assert run("def test_one(): pass", "--write-floor", "test_few.py").ret == pytest.ExitCode.USAGE_ERROR
    lost = run("import nothing_there", "--write-floor")
    assert lost.ret != 0 and floor.read() == {"fast": 1, "slow": 1}
    lost.stdout.no_fnmatch_line("*collected 0 fast*")


def test_workers_tell_who_started_them(run):
    """Who collects nothing himself."""
    floor.write({"fast": 3, "slow": 0})
    found = run(COMMON.format("1.1e-6") + LUCKY, "-n", "1")
    assert found.ret == 1
    found.stdout.fnmatch_lines(
        [
            "tried again, and passed: *",
            "*tests chosen: 1.1e-06 of*",
            "FAILED: the false-alarm*",
            "FAILED: collected 2 *",
        ]
    )


def test_the_bars_are_those_that_are_promised():
    assert suite.BARS == {"fast": 1e-6, "slow": 1e-4}
