"""The benchmarks of accuracy: their arithmetic on made-up runs, their stacks, and the page that is written."""

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks import accuracy, headline
from benchmarks.accuracy_and_time import __main__ as page
from benchmarks.accuracy_and_time import document
from goniosim.report.cost.runs import Run, run
from goniosim.scene import load_scene, parse_scene
from small import SCENE
from synthetic import make_result

NAME = "reflection/internal"
SEEDS = 200


def noisy(sigma, cpu, seed):
    """A run whose slices scatter by ``sigma`` in every cell, with a true error stated."""
    result = make_result(accuracy.ANGLES, components=(NAME,))
    component = result.components[NAME]
    component.bsdf[:] = 5.0 + sigma * np.random.default_rng(seed).normal(size=component.bsdf.shape)
    size = (result.cells.projected_solid_angle * result.cells.valid).sum(axis=(1, 2))
    times = np.full(3, cpu)
    stated = {NAME: sigma * np.sqrt(size)}
    return Run(np.full(3, 1e4), times, times, 0.0, 0.3, stated, {}, {NAME: ["a", "b", "c"]}, result)


@pytest.mark.false_alarm(1e-6, seeds=(0, 10_000))
def test_the_true_error_and_the_gain_are_found(seed):
    """200 seeds of 100 cells: the error within 3 %, the gain within 10 %; false alarms in 1e-6 of the cases."""
    found = {"auto": (0.1, 2.0), "analog": (0.4, 1.0)}
    scatters = {}
    for number, (name, (sigma, cpu)) in enumerate(found.items()):
        scatters[name] = accuracy.Scatter(accuracy.ANGLES, NAME)
        for n in range(SEEDS):
            scatters[name].add(noisy(sigma, cpu, seed + 1000 * number + n))
        assert scatters[name].error == pytest.approx(scatters[name].stated, rel=0.03)
        assert scatters[name].cpu == pytest.approx([cpu + 0.1] * 3)
        assert scatters[name].used == ["a", "b", "c"]
    gain, unknown = accuracy.gains(scatters)
    assert gain == pytest.approx([16.0 * 1.1 / 2.1] * 3, rel=0.1)
    assert ((unknown > 0.005) & (unknown < 0.05)).all()


@pytest.mark.parametrize(
    ("stack", "gain", "told"), [("metal", 499, "MISSED"), ("metal", 500, "reached"), ("metal", 1e4, "aim")]
)
def test_a_gain_is_held_against_what_it_must_be(stack, gain, told):
    assert accuracy.verdict(stack, gain) == told
    assert accuracy.verdict("narrow-slab", gain) == ""


def test_all_stacks_are_scenes_with_the_angles_that_are_looked_at():
    scenes = {path.stem: load_scene(path) for path in accuracy.STACKS.glob("*.yaml")}
    assert scenes.keys() >= accuracy.MUST.keys() | document.CASES.keys()
    for name, scene in scenes.items():
        assert scene.material.name == name
        assert set(accuracy.ANGLES) <= set(scene.incident.theta_deg)
        assert len(scene.incident.theta_deg) == 7


def test_rays_are_found_that_have_the_noise_that_is_needed(monkeypatch, tmp_path):
    monkeypatch.setattr(headline, "RAYS", 2e5)
    scene = parse_scene(SCENE)
    timed = headline.measure(scene, 1e4, tmp_path)
    assert timed.name == "small"
    assert timed.ratios.shape == timed.seconds.shape == (1,)
    # The margin of some per cent against the noise of the smaller run.
    assert timed.ratios[0] <= 1.0
    assert timed.seconds[0] > 0.0
    assert "plastics" in headline.row("plastics", [timed])


def test_directions_that_need_few_rays_are_apart():
    rays = np.array([100, 260, 1000, 900, 520, 499])
    assert headline.groups(rays) == [[2, 3, 4], [1, 5], [0]]
    scene = parse_scene(SCENE.replace("[30]", "[0, 10, 20]"))
    assert list(headline.part(scene, [0, 2]).incident.theta_deg) == [0.0, 20.0]


def test_dark_directions_and_components_need_nothing():
    found = SimpleNamespace(noise={"a": np.array([0.2, 0.0]), "b": np.array([0.1, 0.0])})
    ratios = headline.noise_ratios(found, {"a": np.array([0.4, 0.0]), "b": np.array([0.1, 0.0])})
    assert ratios.tolist() == [1.0, 0.0]


def test_the_error_of_so_many_paths_scales_with_their_root(monkeypatch):
    """Ten times the paths: the noise divided by the root of ten, and about ten times the tracing."""
    scene = parse_scene(SCENE)
    few, _ = headline.needed_noise(scene, 1e4)
    monkeypatch.setattr(headline, "RAYS", 10 * headline.RAYS)
    many, _ = headline.needed_noise(scene, 1e4)
    assert many[NAME] == pytest.approx(few[NAME] / np.sqrt(10.0))
    assert few[NAME] == pytest.approx(run(scene, "analog", 10_000).noise[NAME] * np.sqrt(1e4 / 1.6e8))


@pytest.mark.slow
def test_the_page_is_written_with_its_pictures(monkeypatch, tmp_path):
    from goniosim.report.cost import ladder

    small = {"rows": 6, "columns": 12}
    monkeypatch.setattr(document, "CASES", {name: document.CASES[name] for name in ("plastic", "slab")})
    monkeypatch.setattr(page, "load_scene", lambda path: load_scene(path, [f"slice.{k}={v}" for k, v in small.items()]))
    monkeypatch.setattr(ladder, "FIRST", {"auto": 1 << 11, "analog": 1 << 11})
    (tmp_path / "docs").mkdir()
    assert page.main(["--max-time", "0.1", "--root", str(tmp_path)]) == 0
    text = (tmp_path / "docs" / "accuracy_and_time.md").read_text(encoding="utf-8")
    assert not re.search(r"[{}]|nan|None", text.replace("{target: {relative_error: 1%, of: slice}, max_time: 10m}", ""))
    for picture in re.findall(r"!\[[^]]*\]\(([^)]+)\)", text):
        assert (Path(tmp_path) / "docs" / picture).exists()
    assert len(re.findall("^## ", text, re.MULTILINE)) == 6
