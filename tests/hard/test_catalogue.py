"""The catalogue of hard cases: each holds, is explained, and is found."""

import copy
import dataclasses
import math

import numpy as np
import pytest
from scipy import stats

from goniosim.hard import CASES, Outcome, check, run
from goniosim.hard.catalogue import SCENES, Case
from goniosim.hard.table import case_text, markdown, rows, verdict
from goniosim.hard.topics.randomness import _first_difference
from goniosim.hard.ways import by_estimator
from goniosim.scene import with_arguments

# Take longer than about two seconds.
SLOW = {
    "a_pilot_that_sees_nothing",
    "a_target_out_of_reach",
    "absorbing_nothing",
    "any_number_of_threads",
    "base_of_any_alpha",
    "black_and_white_bases",
    "cells_with_few_hits",
    "channels_1e6_apart",
    "coat_of_any_alpha",
    "dark_rough_stack",
    "dark_stack",
    "dense_coats",
    "dense_rough_interfaces",
    "error_bars_of_audits",
    "infinite_beside_zero",
    "light_in_cut_cells",
    "narrow_coat_over_a_base",
    "neighbouring_seeds",
    "normal_to_grazing",
    "odd_numbers_of_rays",
    "one_cell_receives_all",
    "rarer_below",
    "rows_at_the_horizon",
    "smooth_stacks",
}


def case(name):
    seeds = (0, 1000, 2000)
    slow = [pytest.mark.slow] if name in SLOW else []
    return pytest.param(name, marks=[pytest.mark.false_alarm(3e-4, seeds=seeds), *slow])


def reseeded(case, seed):
    """The case with a scene whose seed is higher by so much."""
    other = dataclasses.replace(case)
    vars(other)["scene"] = with_arguments(case.scene, {"seed": case.scene.simulation.seed + seed})
    return other


@pytest.mark.parametrize("name", [case(name) for name in CASES])
def test_holds(name, seed):
    """The difficulties are told at the head of the scenes in configs/hard, and by a failure here.

    Checks of what is sampled allow 6 standard errors: false alarm 2e-9 for each number, 1e-7 where the error is that of
    64 parts, 1.2e-6 where it is that of 32 replicates: 3e-4 for hundreds of these. Only `neighbouring_seeds` has seeds
    of its own: 2e-7 for 91 pairs.
    """
    (outcome,) = run([reseeded(CASES[name], seed)])
    failed = [f"{each.checked}: expected {each.expected}, got {each.got}" for each in outcome.checks if not each.holds]
    assert not failed, f"{outcome.case.title} {outcome.case.why}"
    assert outcome.checks


def test_scenes_and_functions_belong_together():
    assert {path.stem for path in SCENES.glob("*.yaml")} == set(CASES)
    assert set(CASES) >= SLOW


def test_each_says_what_breaks_naive_code_and_what_holds():
    for each in CASES.values():
        assert len(each.why) > 60, each.name
        assert each.title.endswith("."), each.name


def test_an_error_in_a_case_is_a_check_that_fails():
    def breaks(scene):
        """Break."""
        yield check.statement("first", True, "so", "so")
        raise ZeroDivisionError("float division")

    (outcome,) = run([Case("smooth_stacks", "none", breaks)])
    assert [each.holds for each in outcome.checks] == [True, False]
    assert not outcome.holds
    assert verdict([outcome]) == "1 case, 2 checks: 1 check failed, in 1 case: smooth_stacks"
    assert rows([outcome])[1]["got"] == "ZeroDivisionError: float division"


def test_a_case_without_checks_fails():
    (outcome,) = run([Case("smooth_stacks", "none", lambda scene: ())])
    assert not outcome.holds
    assert verdict([outcome]) == "1 case, 1 check: 1 check failed, in 1 case: smooth_stacks"


@pytest.mark.parametrize("yes, no", [(True, False), (1, 0), (np.True_, np.False_)])
def test_what_is_so_or_not_is_told_by_yes_and_no(yes, no):
    for expected, found, holds in ((True, yes, True), (True, no, False), (False, no, True), (False, yes, False)):
        made = check.whether("x", expected, found)
        assert (made.expected, made.got) == ("yes" if expected else "no", "yes" if found else "no")
        assert made.holds is holds
    assert not check.whether("x", False, None).holds


def test_of_what_is_cut_the_end_stays():
    name = "belcour18_symmetric: light and view exchanged, relative"
    made = check.relative(name, np.ones(960), 1.0, 0.1)
    text = case_text(Outcome(CASES["smooth_stacks"], (made,), 1.0))
    assert "belcour18_symmetric: light and vi... relative (worst of 960)" in text
    usual = check.absolute("all light is accounted for: sum of the audit", np.ones(126), 1.0, 0.1)
    assert f"{usual.checked}  " in case_text(Outcome(CASES["smooth_stacks"], (usual,), 1.0))


def test_what_differs_between_threads_is_named():
    (_, one), *_ = by_estimator(CASES["any_number_of_threads"].scene, rays=100, estimator="analog")
    assert _first_difference(one, one) == ""
    other = copy.deepcopy(one)
    other.audit.energy["transmitted"][0, 0] += 0.5
    other.audit.energy["reflected_internal"][0, 0] *= 1.5
    assert _first_difference(one, other) == "audit reflected_internal differs, relatively by 0.33 at the most"
    other.components["reflection/internal"].stderr[0, 0, 0, 0] = np.nan
    assert _first_difference(one, other).startswith("reflection/internal stderr differs, relatively by nan")


def test_the_page_explains_its_words():
    text = markdown([])
    assert all(f"*{word}*" in text for word in ("Exact adding", "Sums over its slopes", "audit"))


@pytest.mark.parametrize("made", [check.relative, check.absolute])
def test_what_is_not_a_number_fails(made):
    assert not made("x", [1.0, math.nan], [1.0, 1.0], 1.0).holds
    assert not check.in_sigmas("x", [1.0, math.nan], 0.1, 1.0).holds


def test_the_worst_of_many_is_told():
    made = check.in_sigmas("x", np.array([1.0, 1.2]), 0.1, np.array([1.0, 1.0]))
    assert made.deviation == pytest.approx(2.0)
    assert (made.checked, made.expected, made.got) == ("x (worst of 2)", "1", "1.2 ± 0.1")
    assert made.holds and not check.in_sigmas("x", 1.7, 0.1, 1.0).holds


def test_nothing_seen_may_be_a_path_unseen():
    assert check.in_sigmas("x", 0.0, 0.0, 1e-6, unseen=1e-5).holds
    assert not check.in_sigmas("x", 0.0, 0.0, 1e-6).holds
    assert not check.in_sigmas("x", 1e-5, 1e-8, 1.1e-5, unseen=1e-5).holds


@pytest.mark.parametrize("freedom", [6, 138])
def test_a_chi_square_in_sigmas(freedom):
    """Wilson and Hilferty's formula is good to some per cent out there."""
    for sigmas in (5.5, -3.0):
        made = check.chi_square("x", [np.sqrt(stats.chi2.isf(stats.norm.sf(sigmas), freedom))], freedom)
        assert made.holds and made.deviation == pytest.approx(abs(sigmas), rel=0.05)
    assert not check.chi_square("x", [np.sqrt(stats.chi2.isf(1e-11, freedom))], freedom).holds
    assert not check.chi_square("x", [math.nan], freedom).holds


def test_students_t_in_sigmas():
    t = stats.t.isf(stats.norm.sf(5.5), 31)
    assert check.t_in_sigmas("x", [0.1, -t], 31).deviation == pytest.approx(5.5, rel=0.01)
    assert not check.t_in_sigmas("x", [math.nan, 0.0], 31).holds
