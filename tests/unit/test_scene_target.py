"""Targets in scenes: how they are written, what they take the place of, from a file, an override or Python."""

import pytest
from goniosim_cli import options

import goniosim
from goniosim.errors import ConfigError
from goniosim.scene import parse_scene, total_rays, with_arguments
from patina import patina
from small import SCENE, STUDY

SHARE = "must lie above 0 and below 1: one percent is 1% or 0.01"
TIME = "must be a time above 0: seconds, or 90s, 10m, 2h or 1h30m"
BOTH = "must not stand beside target, which decides how many are traced: remove one of them"
IDLE = "limits a target, and there is none: add target: {relative_error: 1%}, or remove it"


def scene(simulation, overrides=()):
    return parse_scene(SCENE.replace("{rays: 1e4, seed: 1}", simulation), "f.yaml", overrides)


def problems_of(*arguments, call=scene, **named):
    with pytest.raises(ConfigError) as caught:
        call(*arguments, **named)
    return [line.removeprefix("f.yaml:9: simulation.") for line in caught.value.problems]


@pytest.mark.parametrize(
    "written, share",
    [("1%", 0.01), ("0.7 %", 0.007), ("'1e-1%'", 0.001), ("0.01", 0.01), ("1e-3", 0.001), ("99.9%", 0.999)],
)
def test_an_error_is_a_share_or_a_percentage(written, share):
    simulation = scene(f"{{target: {{relative_error: {written}}}}}").simulation
    assert (simulation.target.relative_error, simulation.target.of, simulation.rays) == (share, "slice", None)


@pytest.mark.parametrize(
    "written, said",
    [
        ("1", f"{SHARE} [got 1]"),
        ("0", f"{SHARE} [got 0]"),
        ("100%", f"{SHARE} [got '100%']"),
        ("-1%", f"{SHARE} [got '-1%']"),
        ("nan%", f"must be finite, and {SHARE.removeprefix('must ')} [got 'nan%']"),
        ("some%", f"must be a number, and {SHARE.removeprefix('must ')} [got 'some%']"),
        ("true", f"must be a number, and {SHARE.removeprefix('must ')} [got true]"),
        ("'0,5%'", "must be a number without a comma: write 0.5% [got '0,5%']"),
        ("'0.01'", "must be a number, and it is text here: write it without quotes [got '0.01']"),
    ],
)
def test_what_is_no_error(written, said):
    assert problems_of(f"{{target: {{relative_error: {written}}}}}") == [f"target.relative_error: {said}"]


@pytest.mark.parametrize(
    "written, seconds",
    [("90", 90), ("0.5", 0.5), ("90s", 90), ("10m", 600), ("2h", 7200), ("1h30m", 5400), ("1.5h2m3s", 5523)],
)
def test_a_time_has_units_or_is_in_seconds(written, seconds):
    assert scene(f"{{target: {{relative_error: 1%}}, max_time: {written}}}").simulation.max_time == seconds


@pytest.mark.parametrize(
    "written, shown",
    [("0", "0"), ("0s", "'0s'"), ("-1", "-1"), ("''", "''"), ("1:30", "'1:30'"), ("30m1h", "'30m1h'"), ("2d", "'2d'")],
)
def test_what_is_no_time(written, shown):
    said = problems_of(f"{{target: {{relative_error: 1%}}, max_time: {written}}}")
    assert said == [f"max_time: {TIME} [got {shown}]"]


@pytest.mark.parametrize(
    "simulation, lines",
    [
        ("{target: {relative_error: 1%}, rays: 1e5}", [f"rays: {BOTH} [got 100000.0]"]),
        ("{max_rays: 1e5}", [f"max_rays: {IDLE} [got 100000.0]"]),
        ("{rays: 100, max_time: 10m}", [f"max_time: {IDLE} [got '10m']"]),
        (
            "{target: 1%}",
            ["target: must be a mapping with relative_error and of: write target: {relative_error: 1%} [got '1%']"],
        ),
        ("{target: {of: albedo}}", ["target.relative_error: is missing: this key is required"]),
        (
            "{target: {relative_error: 1%, of: slices}}",
            ["target.of: must be slice, albedo or cells [got 'slices'] (did you mean slice?)"],
        ),
    ],
)
def test_a_target_and_rays_exclude_each_other_on_one_level(simulation, lines):
    assert problems_of(simulation) == lines


FILE = "{target: {relative_error: 2%, of: cells}, max_rays: 1e9, max_time: 1m}"


@pytest.mark.parametrize(
    "file, overrides, expected",
    [
        ("{rays: 1e5}", ["target.relative_error=1%"], (None, "1 % of slice", None, None)),
        ("{rays: 1e5}", ["target={relative_error: 1%, of: albedo}"], (None, "1 % of albedo", None, None)),
        ("{rays: 1e5}", ["target.relative_error=1%", "max_time=1h"], (None, "1 % of slice", None, 3600.0)),
        (FILE, ["target.relative_error=0.5%"], (None, "0.5 % of cells", 10**9, 60.0)),
        (FILE, ["max_rays=1e8"], (None, "2 % of cells", 10**8, 60.0)),
        (FILE, ["rays=1e5"], (100_000, None, None, None)),
    ],
)
def test_an_override_takes_the_place_of_what_it_excludes(file, overrides, expected):
    found = scene(file, [f"simulation.{each}" for each in overrides]).simulation
    target = None if found.target is None else str(found.target)
    assert (found.rays, target, found.max_rays, found.max_time) == expected


def test_the_whole_simulation_may_be_overridden_after_a_part_of_it():
    changes = ["simulation.target.relative_error=1%", "simulation={rays: 200}"]
    assert scene("{rays: 1e5}", changes).simulation.rays == 200


@pytest.mark.parametrize("file", ["{rays: 1e5}", FILE])
def test_overrides_are_one_level(file):
    with pytest.raises(ConfigError, match="rays: must not stand beside target"):
        scene(file, ["simulation.rays=1e5", "simulation.target={relative_error: 1%}"])
    with pytest.raises(ConfigError, match="max_time: limits a target, and there is none"):
        scene(file, ["simulation.rays=1e5", "simulation.max_time=1m"])


TARGET = (
    "unknown key; to stop at an accuracy, write target: {relative_error: 1%} instead of rays (did you mean target?)"
)


@pytest.mark.parametrize(
    "new, lines",
    [
        ("tolerance: 0.01", [f"tolerance: {TARGET}"]),
        ("noise_level: 1%", [f"noise_level: {TARGET}"]),
        (
            "error: 200%",
            [
                f"error: {TARGET}",
                "error.relative_error: must lie above 0 and below 1: one percent is 1% or 0.01 [got '200%']",
            ],
        ),
        (
            "target: {relative_error: 1%}, time_budget: 600",
            ["time_budget: unknown key; max_time limits a target (did you mean max_time: 600?)"],
        ),
        (
            "target: {tolerance: 0.01, metric: energy}, max_spp: 1e9",
            [
                "target.metric: unknown key; what the error is of (did you mean of?)",
                "target.metric: must be slice, albedo or cells [got 'energy'] (did you mean albedo?)",
                "max_spp: unknown key; max_rays limits a target (did you mean max_rays: 1000000000?)",
                "target.tolerance: unknown key; relative_error is a standard error over what it is the "
                "error of: 1% or 0.01 (did you mean relative_error: 0.01?)",
            ],
        ),
        (
            "rays: 1e7, estimator: brute_force",
            [
                "estimator: must be auto, analog, split, operator or connection [got 'brute_force'] "
                "(did you mean analog?)"
            ],
        ),
    ],
)
def test_a_foreign_word_for_an_accuracy(new, lines):
    assert sorted(problems_of(f"{{{new}}}")) == sorted(lines)


def test_the_materials_of_a_study_share_a_target():
    study = STUDY.replace("{rays: 1e4, seed: 1}", FILE)
    scenes = goniosim.load_scenes(study)
    assert {str(each.simulation.target) for each in scenes} == {"2 % of cells"}
    assert total_rays(scenes) is None
    assert total_rays(goniosim.load_scenes(study, ["simulation.rays=100"])) == 300


def test_a_template_may_hold_a_target():
    study = STUDY.replace("{rays: 1e4, seed: 1}", "{target: {relative_error: '${alpha}'}}")
    found = [each.simulation.target.relative_error for each in goniosim.load_scenes(study)]
    assert found == [0.1, 0.2, 0.3]


def test_a_scene_says_its_target_in_short():
    found = patina(simulation={"target": {"relative_error": 0.0015, "of": "albedo"}, "max_rays": 1e6})
    assert "; target 0.15 % of albedo; seed 1>" in repr(found)
    assert (found.total_rays, found.simulation.most_rays) == (None, 10**6)
    assert patina(simulation={"target": {"relative_error": 0.5}}).simulation.most_rays == 10**15


@pytest.mark.parametrize(
    "file, given, expected",
    [
        ("{rays: 1e5}", {"target": "1%"}, (None, "1 % of slice", None, None)),
        ("{rays: 1e5}", {"target": 0.01, "of": "cells", "max_time": "1m"}, (None, "1 % of cells", None, 60.0)),
        (FILE, {"target": 0.01}, (None, "1 % of cells", 10**9, 60.0)),
        (FILE, {"of": "slice", "max_rays": 1e6}, (None, "2 % of slice", 10**6, 60.0)),
        (FILE, {"rays": 1e5}, (100_000, None, None, None)),
    ],
)
def test_arguments_take_the_place_of_what_they_exclude(file, given, expected):
    made = with_arguments(scene(file), given)
    found = made.simulation
    target = None if found.target is None else str(found.target)
    assert (found.rays, target, found.max_rays, found.max_time) == expected
    assert parse_scene(made.to_yaml()) == made


@pytest.mark.parametrize(
    "given, lines",
    [
        ({"target": 1}, [f"target {SHARE} [got 1]"]),
        ({"max_time": "soon", "target": "1%"}, [f"max_time {TIME} [got 'soon']"]),
        (
            {"estimator": "analogue", "of": 3},
            [
                "estimator must be auto, analog, split, operator or connection; did you mean analog? [got 'analogue']",
                "of must be slice, albedo or cells [got 3]",
            ],
        ),
        (
            {"rays": 1e5, "target": 0.01},
            ["rays must not stand beside target, which decides how many are traced: give one of them"],
        ),
        ({"of": "albedo"}, ["of belongs to a target, and there is none: give target=0.01"]),
        (
            {"max_rays": 1e5, "max_time": 3},
            [
                "max_rays belongs to a target, and there is none: give target=0.01",
                "max_time belongs to a target, and there is none: give target=0.01",
            ],
        ),
    ],
)
@pytest.mark.parametrize("simulate", [goniosim.simulate, goniosim.simulate_study])
def test_arguments_that_are_wrong(simulate, given, lines):
    assert problems_of(SCENE, call=simulate, **given) == lines


def test_rays_as_an_argument_end_limits_too():
    given = {"rays": 1e5, "max_time": 3}
    assert problems_of(scene(FILE), call=goniosim.simulate, **given) == [
        "max_time belongs to a target, and there is none: give target=0.01"
    ]


def test_options_of_the_command_line_know_the_words_of_the_scene():
    """They are written there again, so that help needs nothing of the scene."""
    from goniosim.scene.checking import CHOICES

    assert CHOICES["estimator"] == options.ESTIMATORS
    assert CHOICES["of"] == options.OF
