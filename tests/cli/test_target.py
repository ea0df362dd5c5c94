"""`goniosim simulate` and `check` where an accuracy is asked for instead of rays."""

import json
import os
import re
import signal
from types import SimpleNamespace

import numpy as np
import pytest

import goniosim as package
from goniosim import engine
from goniosim.store import Standing, open_result, write_result

TIMES = "1% --max-time 10m"
KEPT = "; the result is kept: raise max_time, or ask for less"
MISSED = "goniosim: small.h5: the target of 1 % of slice was not reached with at most 10 min"


@pytest.fixture
def aimed(monkeypatch):
    """An engine that obeys targets: with ``rays`` per direction, and whether that reaches them, by material."""
    simulate = engine.simulate
    plan = {"rays": 1000, "missed": set(), "asked": [], "interrupted": False}

    def obey(scene, progress, stop, **_):
        plan["asked"].append(scene.simulation)
        changes = {"rays": plan["rays"], "target": None, "max_rays": None, "max_time": None}
        result = simulate(scene.model_copy(update={"simulation": scene.simulation.model_copy(update=changes)}))
        progress(plan["rays"], scene.total_rays)
        if plan["interrupted"]:
            os.kill(os.getpid(), signal.SIGINT)
            assert stop.wait(10.0)
            result.status = "partial"
        result.config_yaml, result.config_hash = scene.to_yaml(), scene.config_hash()
        if scene.simulation.target is not None:
            result.target_reached = scene.material.name not in plan["missed"] and not plan["interrupted"]
        return result

    monkeypatch.setattr(engine, "simulate", obey)
    return plan


def call(goniosim, line, config="scene.yaml"):
    return goniosim("simulate", config, *line.split())


def test_every_option_arrives(goniosim, folder, aimed):
    options = "--target 0.7% --of albedo --max-rays 1e9 --max-time 1h30m --estimator analog --seed 3 --threads 2"
    assert call(goniosim, f"{options} -q") == (0, "", "")
    (asked,) = aimed["asked"]
    assert (asked.target.relative_error, asked.target.of, asked.rays) == (0.007, "albedo", None)
    assert (asked.max_rays, asked.max_time, asked.estimator, asked.seed, asked.threads) == (10**9, 5400, "analog", 3, 2)
    assert open_result(folder / "small.h5").target_reached is True


@pytest.mark.parametrize(
    "line, code, said",
    [
        ("--rays 1e5 --target 1%", 2, "Error: --target decides how many rays are traced: give it or --rays"),
        ("--target 200%", 2, "'200%' must lie above 0 and below 1: one percent is 1% or 0.01"),
        ("--target 0,5%", 2, "'0,5%' must be a number without a comma: write 0.5%"),
        ("--target 1% --max-time soon", 2, "'soon' must be a time above 0: seconds, or 90s, 10m, 2h or 1h30m"),
        ("--target 1% --of pixels", 2, "'pixels' is not one of 'slice', 'albedo', 'cells'."),
        ("--estimator analogue", 2, "'analogue' is not one of 'auto', 'analog', 'split', 'operator', 'connection'."),
        ("--tolerance 1%", 2, "No such option '--tolerance': did you mean --target?"),
        ("--timeout 60", 2, "No such option '--timeout': did you mean --max-time?"),
        (
            "--max-time 10m",
            3,
            "--max-time 10m: simulation.max_time: limits a target, and there is none: "
            "add target: {relative_error: 1%}, or remove it [got '10m']",
        ),
        ("--of albedo", 3, "--of albedo: simulation.target.relative_error: is missing: this key is required"),
    ],
)
@pytest.mark.parametrize("command", ["simulate", "check"])
def test_what_does_not_go_together(goniosim, folder, command, line, code, said):
    found, out, err = goniosim(command, "scene.yaml", *line.split())
    assert (found, out) == (code, "")
    assert any(each.endswith(said) for each in err.splitlines()), err
    assert not (folder / "small.h5").exists()


def lines_of(err):
    """What was said, but for the word on kernels that a first run has."""
    return [line for line in err.splitlines() if "preparing the kernels" not in line]


def test_a_target_that_is_missed_is_9_and_the_result_is_kept(goniosim, folder, aimed):
    aimed["missed"].add("small")
    code, out, err = call(goniosim, f"--target {TIMES}")
    (line,) = lines_of(err)
    assert (code, line.removeprefix(MISSED).endswith(KEPT)) == (9, True)
    takes = r" \(it is at \d+ %, and takes about \S+ rays per direction and \S+ \w+ in all\)"
    assert re.fullmatch(takes, line[len(MISSED) : -len(KEPT)])
    assert "target: 1 % of slice, at most 10 min: not reached" in out
    result = open_result(folder / "small.h5")
    assert (result.status, result.target_reached) == ("complete", False)
    code, out, _ = goniosim("info", "small.h5")
    assert (code, "target: 1 % of slice, at most 10 min: not reached" in out) == (0, True)
    assert json.loads(goniosim("info", "small.h5", "--json")[1])["target_reached"] is False
    # Once more, to no avail: nothing is traced, and it is still missed.
    before = (folder / "small.h5").read_bytes()
    for line in (TIMES, "1% --max-time 5m --max-rays 1e6"):
        code, out, err = call(goniosim, f"--target {line}")
        assert (code, out, err.splitlines()[-1]) == (9, "", MISSED + KEPT)
        assert "stays as it is: it holds 1000 rays per direction of this scene, by a target of 1 % of slice" in err
    assert call(goniosim, f"--target {TIMES} -q") == (9, "", f"{MISSED}{KEPT}\n")
    assert (len(aimed["asked"]), (folder / "small.h5").read_bytes()) == (1, before)
    # Whoever asks for these rays has them.
    assert call(goniosim, "--rays 1000 -q") == (0, "", "")
    # What it missed says nothing of less; it is worth more than the run that tells.
    aimed["missed"].clear()
    aimed["rays"] = 900
    assert "small.h5 stays as it is: it holds 1000 rays" in call(goniosim, "--target 2% --max-time 10m")[2]
    # More time is worth another run.
    aimed["rays"] = 2000
    assert call(goniosim, "--target 1% --max-time 11m -q") == (0, "", "")
    assert (len(aimed["asked"]), open_result(folder / "small.h5").target_reached) == (3, True)


@pytest.mark.parametrize(
    "line, traced",
    [
        ("--target 1%", 1),
        ("--target 0.05 --max-rays 1e5", 1),
        ("--rays 1000", 1),
        ("--rays 500", 1),
        ("--target 0.9%", 2),
        ("--target 1% --of albedo", 2),
        ("--rays 2000", 2),
    ],
)
def test_a_target_that_was_reached_serves_all_that_are_no_stricter(goniosim, folder, aimed, line, traced):
    assert call(goniosim, f"--target {TIMES} -q") == (0, "", "")
    aimed["rays"] = 2000
    assert call(goniosim, f"{line} -q") == (0, "", "")
    assert len(aimed["asked"]) == traced
    assert open_result(folder / "small.h5").rays.tolist() == [2000 if traced == 2 else 1000]


def test_a_result_with_more_rays_is_not_replaced_by_one_of_a_target(goniosim, folder, aimed):
    aimed["rays"] = 3000
    assert call(goniosim, "--rays 3000 -q") == (0, "", "")
    aimed["rays"] = 1000
    code, _, err = call(goniosim, "--target 1%")
    held = "small.h5 stays as it is: it holds 3000 rays per direction of this scene, the new result 1000"
    assert (code, err.splitlines()[-1].endswith(held)) == (0, True)


def test_rays_that_a_target_spread_count_together():
    asked = {name: package.load_scene(ONE, [change]).simulation for name, change in CHANGES.items()}
    spread = Standing(np.array([500, 3500]), (), "complete", "", asked["target"], True)
    partial = Standing(np.array([500, 3500]), (), "partial", "", asked["rays"], None)
    assert (spread.holds(asked["rays"]), partial.holds(asked["rays"])) == (True, False)
    for rays, kept in ((1000, True), (2000, False)):
        assert spread.outweighs(SimpleNamespace(rays=np.array([rays, rays]), estimator="")) == kept
    assert not partial.holds(asked["target"])


def test_what_saw_nothing_gives_way_to_another_estimator():
    """It is without noise, and worth less for that."""
    cost = SimpleNamespace(error={"transmission": np.array([[1e-9]])})
    new = SimpleNamespace(rays=np.array([1000]), estimator="operator", cost=cost)
    for noise, kept in ((0.0, False), (1e-10, True), (1e-8, False)):
        there = Standing(np.array([10**6]), (), "complete", estimator="analog", noise=noise)
        assert there.outweighs(new) == kept


ONE = """
material: {name: one, layers: [{interface: {type: lambert, rho: 1}}]}
incident: {theta_deg: [0, 30]}
"""
CHANGES = {"target": "simulation.target={relative_error: 1%}", "rays": "simulation.rays=2000"}


def test_in_a_study_all_files_are_written_before_a_miss_counts(goniosim, folder, aimed):
    aimed["missed"] |= {"coat-0.1", "coat-0.3"}
    code, out, err = call(goniosim, f"--target {TIMES} -o out", "study.yaml")
    assert code == 9 and out.count("complete") == 3
    assert [line.split(": ")[1] for line in lines_of(err)] == ["out/coat-0.1.h5", "out/coat-0.3.h5"]
    assert len(list((folder / "out").glob("*.h5"))) == 3
    code, _, err = call(goniosim, f"--target {TIMES} -o out", "study.yaml")
    assert (code, len(aimed["asked"])) == (9, 3)
    _, table, _ = goniosim("info", "out")
    assert table.count("1 % of slice") == 3
    entries = json.loads(goniosim("info", "out", "--json")[1])
    assert [(each["rays"], each["target"]) for each in entries] == [
        (None, {"relative_error": 0.01, "of": "slice"}) for _ in range(3)
    ]


def test_a_python_study_goes_on_where_targets_are_reached(folder, aimed):
    for _ in range(2):
        files = package.simulate_study("study.yaml", folder="out", target="1%", max_time="10m")
        assert len(files) == 3 and len(aimed["asked"]) == 3
    package.simulate_study("study.yaml", folder="out", target=0.001)
    assert len(aimed["asked"]) == 6


def test_an_interrupted_run_tells_its_rays_and_misses_nothing(goniosim, folder, aimed):
    aimed["interrupted"] = True
    code, _, err = call(goniosim, f"--target {TIMES}")
    assert code == 130
    assert err.splitlines()[-1].endswith("stopped by Ctrl-C: small.h5 holds 1000 rays per direction (partial)")
    # It is no answer to the same question, though it has rays.
    aimed["interrupted"] = False
    assert call(goniosim, f"--target {TIMES} -q") == (0, "", "")
    assert open_result(folder / "small.h5").status == "complete"


def test_an_analog_result_is_another_estimate_than_auto(goniosim, folder, monkeypatch):
    """As in files from before there was a choice: their scenes all say analog."""
    scene = package.load_scene("scene.yaml", ["simulation.rays=100", "simulation.estimator=analog"])
    write_result(package.simulate(scene), folder / "small.h5")
    monkeypatch.setattr(engine, "simulate", lambda *_, **__: pytest.fail("traced again"))
    code, _, err = call(goniosim, "--rays 100")
    assert (code, err.splitlines()[0]) == (4, "small.h5: simulation.estimator: analog in the file, auto asked for")
    assert call(goniosim, "--rays 100 --estimator analog -q") == (0, "", "")


@pytest.fixture
def short_probe(monkeypatch):
    monkeypatch.setattr("goniosim.report.simulation.forecast.PROBE", 0.01)
    monkeypatch.setattr("goniosim.report.simulation.forecast.PROBE_STUDY", 0.01)


@pytest.mark.parametrize(
    "line, time, seconds",
    [
        ("", "until 1 % of slice is reached", None),
        ("--max-time 10m", "until 1 % of slice is reached, at most 10 min", 600.0),
        ("--max-rays 1000000000000000 --max-time 10m", "until 1 % of slice is reached, at most 10 min", 600.0),
    ],
)
def test_check_tells_what_limits_a_target(goniosim, folder, short_probe, line, time, seconds):
    code, out, _ = goniosim("check", "scene.yaml", "--target", "1%", *line.split())
    assert code == 0
    assert f"  time        {time}\n" in out
    assert "  target: 1 % of slice" in out
    one = json.loads(goniosim("check", "scene.yaml", "--target", "1%", *line.split(), "--json")[1])
    assert (one["seconds"], one["rays"], one["target"]) == (seconds, None, {"relative_error": 0.01, "of": "slice"})


def test_check_of_a_study_with_a_target(goniosim, folder, short_probe):
    _, out, _ = goniosim("check", "study.yaml", "--target", "1%")
    assert out.count("1 % of slice") == 3 and "  Together: as it takes, at most" in out
    assert json.loads(goniosim("check", "study.yaml", "--target", "1%", "--json")[1])["seconds"] is None
    _, out, _ = goniosim("check", "study.yaml", "--target", "1%", "--max-time", "10m")
    assert "  Together: 30 min, at most" in out
    fewest = json.loads(goniosim("check", "scene.yaml", "--target", "1%", "--max-rays", "1e9", "--json")[1])
    assert fewest["seconds"] == pytest.approx(1e9 / fewest["rays_per_second"])


def test_a_miss_of_the_operator_names_what_limits_it(goniosim, folder, aimed):
    aimed["missed"].add("small")
    code, _, err = call(goniosim, "--target 1% --estimator operator")
    said = "ask for less, or leave the estimator to auto: what nodes may be off by limits this one"
    assert code == 9 and err.splitlines()[-1].endswith(f"the result is kept: {said}")


def test_a_target_that_nobody_lives_to_see_ends_with_a_word(goniosim, folder):
    """It would go on for ever, since nothing limits it; instead it says so after two rounds, and ends."""
    code, out, err = call(goniosim, "--target 1e-12 --estimator split", "scene.yaml")
    told, *_, missed = lines_of(err)
    takes = r"takes about \S+ rays per direction and \S+ years"
    # Two rounds.
    at = r"small: reflection/internal is at \S+ % after 3.932e5 rays per direction"
    assert re.search(f"{at}; the target of 1e-10 % of slice {takes} more$", told)
    assert re.search(rf"not reached \(it is at \S+ %, and {takes} in all\); the result is kept: ask for less$", missed)
    assert (code, open_result(folder / "small.h5").target_reached) == (9, False)
    # Nor is it tried again.
    code, _, err = call(goniosim, "--target 1e-12 --estimator split", "scene.yaml")
    assert code == 9 and "stays as it is" in err


UNSEEN = """
material:
  name: unseen
  layers:
    - interface: {type: dielectric, eta: 1.0000001, alpha: 0.2}
    - medium: {tau: 3}
    - interface: {type: lambert, rho: 0.5}
incident: {theta_deg: [89.999]}
slice: {rows: 9, columns: 18}
"""


def test_a_target_on_what_nobody_sees_is_missed(goniosim, folder):
    (folder / "unseen.yaml").write_text(UNSEEN)
    code, out, err = goniosim("simulate", "unseen.yaml", "--target", "10%", "--max-time", "1s")
    nothing = r"nothing was seen at 89.999 deg: at most \S+"
    assert code == 9 and "target: 10 % of slice, at most 1 s: not reached" in out
    assert re.search(rf"not reached with at most 1 s \(reflection/internal: {nothing}\); the result is kept", err)
    for told in (out, goniosim("info", "unseen.h5")[1]):
        assert re.search(rf"  reflection/internal   {nothing} \(target 10 % of slice\)\n", told)
        assert "better" not in told and "Half the noise" not in told
    # A black base is no target to miss.
    (folder / "unseen.yaml").write_text(UNSEEN.replace("rho: 0.5", "rho: 0"))
    code, out, _ = goniosim("simulate", "unseen.yaml", "--target", "10%", "--overwrite")
    assert code == 0 and "  reflection/internal   dark: no light leaves this way" in out


def test_a_target_beyond_its_limits_is_told_early(goniosim, folder):
    code, _, err = call(goniosim, "--target 1e-5 --max-rays 1e6 --estimator split", "scene.yaml")
    told, *again, missed = lines_of(err)
    # Again only if the pace changed much, as on a busy machine.
    assert code == 9 and all(
        line.endswith("more, beyond the limits: at most 1e6 rays per direction") for line in (told, *again)
    )
    assert missed.endswith("the result is kept: raise max_rays, or ask for less")
    # Where it is near, there is nothing to say.
    code, _, err = call(goniosim, "--target 5% --max-rays 1e8 --estimator split", "scene.yaml")
    assert (code, lines_of(err)[1:]) == (0, [])
