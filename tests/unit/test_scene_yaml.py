"""What YAML offers besides plain mappings: anchors, aliases and merge keys, with lines, and with bounds."""

import io
import sys
import time

import pytest

from goniosim.errors import ConfigError
from goniosim.scene import load_config, load_scene, load_scenes, parse_scene

SCENE = """\
material:
  name: coats
  layers:
    - interface: &coat {type: dielectric, eta: 1.5, alpha: 0.2}
    - medium: &clear {tau: 0}
    - interface: {<<: *coat, eta: 1.3}
    - medium: *clear
    - interface:
        alpha: 0.1
        <<: [{eta: 1.7}, *coat]
incident: {theta_deg: [30]}
"""

STUDY = """\
study:
  name: two
  materials:
    - &base
      name: a
      layers:
        - interface: {type: dielectric, eta: 1.5}
        - interface: {type: lambert, rho: 0.5}
    - {<<: *base, name: b}
incident: {theta_deg: [30]}
"""


def problems_of(text):
    with pytest.raises(ConfigError) as caught:
        parse_scene(text, "f.yaml")
    return caught.value.problems


def test_merge_keys_take_over_what_is_not_written():
    faces = parse_scene(SCENE).material.interfaces
    assert [(face.type, face.eta, face.alpha) for face in faces] == [
        ("dielectric", 1.5, 0.2),
        ("dielectric", 1.3, 0.2),
        ("dielectric", 1.7, 0.1),
    ]


def test_merge_keys_work_in_studies(tmp_path):
    path = tmp_path / "study.yaml"
    path.write_text(STUDY)
    first, second = load_scenes(path)
    assert (first.material.name, second.material.name) == ("a", "b")
    assert first.material.layers == second.material.layers


def test_a_mistake_is_where_it_was_written():
    text = SCENE.replace("eta: 1.5, alpha: 0.2", "eta: 1.5, alpha: 2").replace("tau: 0", "tau: -1")
    place = "material.layers[{}].{}"
    assert [line.split(": ")[:2] for line in problems_of(text)] == [
        ["f.yaml:4", place.format(0, "interface.alpha")],
        ["f.yaml:4", place.format(2, "interface.alpha")],
        ["f.yaml:5", place.format(1, "medium.tau")],
        ["f.yaml:5", place.format(3, "medium.tau")],
    ]
    assert problems_of(SCENE.replace("eta: 1.3", "ior: 1.3"))[0].startswith(
        "f.yaml:6: material.layers[2].interface.ior: "
    )
    assert problems_of(SCENE.replace("*coat, eta", "7, eta"))[0] == (
        "f.yaml:6: material.layers[2].interface.<<: takes over the entries of a mapping, or of a list of them: "
        "write <<: *name"
    )


def test_overrides_reach_what_was_taken_over():
    scene = parse_scene(SCENE, overrides=["material.layers[2].interface.alpha=0.3"])
    assert [face.alpha for face in scene.material.interfaces] == [0.2, 0.3, 0.1]


def test_a_bomb_of_merge_keys_is_refused_at_once():
    text = "a: &a0 {}\n"
    for level in range(1, 12):
        text += f"b{level}: &a{level} {{<<: [{', '.join([f'*a{level - 1}'] * 10)}]}}\n"
    started = time.perf_counter()
    for bomb in (text, "a: &a {<<: *a}\n"):
        assert problems_of(bomb) == ["f.yaml:1: is nested too deeply, or holds too many values, for a scene file"]
    # A tenth of that as measured; unbounded, it takes hours.
    assert time.perf_counter() - started < 10.0


def test_a_study_cannot_multiply_a_bomb(tmp_path):
    path = tmp_path / "study.yaml"
    axes = ", ".join(f"x{n}: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]" for n in range(4))
    path.write_text(f"""\
study:
  name: bomb
  cross: {{{axes}}}
  material: {{name: "a-${{x0}}", layers: [&a {{interface: {{type: lambert, rho: 1}}}}{", *a" * 100}]}}
incident: {{theta_deg: [0]}}
""")
    with pytest.raises(ConfigError) as caught:
        load_scenes(path)
    assert caught.value.problems == [
        f"{path}:3: study.cross: gives 10000 materials with more than 2000000 values in all: shorten an axis"
    ]


def test_a_dash_is_the_standard_input(monkeypatch):
    def give(text):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))

    give(SCENE)
    assert load_scene("-") == parse_scene(SCENE)
    give(STUDY)
    config = load_config("-", ["study.name=three"])
    assert (config.study, len(config.scenes)) == ("three", 2)
    give(SCENE.replace("30", "95"))
    with pytest.raises(ConfigError) as caught:
        load_scenes("-")
    assert caught.value.problems[0].startswith("<stdin>:11: incident.theta_deg[0]: must ")
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(ConfigError, match="<stdin>: is closed: give a file"):
        load_scene("-")
