"""Reading scene files: YAML, overrides, and which function takes which file."""

import pytest

from goniosim.errors import ConfigError
from goniosim.scene import load_config, load_scene, load_scenes, parse_scene

SCENE = """\
material:
  name: white
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - medium: {tau: 0.1}
    - interface: {type: lambert, rho: [0.1, 0.6, 0.1]}
incident: {theta_deg: [0, 45]}
simulation: {rays: 1e7, seed: 3}
"""

STUDY = """\
study:
  name: two
  materials:
    - name: a
      layers: [{interface: {type: lambert, rho: 0.5}}]
    - name: b
      layers: [{interface: {type: lambert, rho: 0.7}}]
incident: {theta_deg: [0, 45]}
"""


def write(folder, text, name="scene.yaml"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_its_text_and_its_dict_make_the_same_scene(tmp_path):
    path = write(tmp_path, SCENE)
    scene = load_scene(path)
    assert load_scene(str(path)) == scene
    assert load_scenes(path) == [scene]
    assert parse_scene(SCENE) == scene
    assert parse_scene(scene.model_dump(exclude_none=True)) == scene
    assert scene.simulation.rays == 10_000_000


@pytest.mark.parametrize(
    "written, rays",
    [("1e7", 10**7), ("1E+7", 10**7), ("1_000", 1000), ("1000.0", 1000), ("0x400", 1024), ("+200", 200)],
)
def test_numbers_follow_yaml_1_2(written, rays):
    assert parse_scene(SCENE.replace("1e7", written)).simulation.rays == rays


def test_a_word_that_yaml_1_1_takes_for_a_boolean_is_a_name():
    assert parse_scene(SCENE.replace("white", "off")).material.name == "off"


def test_byte_order_mark_windows_line_ends_comments_and_anchors(tmp_path):
    path = tmp_path / "scene.yaml"
    path.write_bytes(b"\xef\xbb\xbf# begin\r\n" + SCENE.replace("\n", "\r\n").encode())
    assert load_scene(path) == parse_scene(SCENE)
    reused = SCENE.replace("rho: [0.1, 0.6, 0.1]", "rho: &half 0.5").replace("[0, 45]", "[0, *half]")
    assert parse_scene(reused).incident.theta_deg == (0.0, 0.5)


def test_overrides_replace_add_and_make_what_is_absent():
    scene = parse_scene(
        SCENE,
        overrides=[
            "simulation.rays=1e6",
            "material.layers[0].interface.alpha=0.1",
            "material.layers[2].interface.rho[1]=0.25",
            "slice.rows=45",
            "incident.theta_deg=[10, 20, 30]",
            "simulation.orders=2",
        ],
    )
    assert scene.simulation.rays == 1_000_000
    assert scene.simulation.seed == 3
    assert scene.simulation.orders == 2
    assert scene.material.interfaces[0].alpha == 0.1
    assert scene.material.interfaces[1].rho == (0.1, 0.25, 0.1)
    assert scene.slice.rows == 45
    assert scene.incident.theta_deg == (10.0, 20.0, 30.0)


def test_the_last_override_wins_and_may_replace_a_whole_mapping():
    scene = parse_scene(SCENE, overrides=["simulation.rays=5000", "simulation={rays: 200}"])
    assert (scene.simulation.rays, scene.simulation.seed) == (200, 1)
    scene = parse_scene(SCENE, overrides=["simulation={rays: 200}", "simulation.rays=5000"])
    assert scene.simulation.rays == 5000


def test_an_override_mends_a_mistake_of_the_file():
    assert parse_scene(SCENE.replace("1.5", "15"), overrides=["material.layers[0].interface.eta=1.5"])


@pytest.mark.parametrize(
    "assignment, line",
    [
        ("simulation.rays", "must be path=value, such as simulation.rays=1e6"),
        ("=5", "must be path=value, such as simulation.rays=1e6"),
        ("material..name=a", "must be path=value, such as simulation.rays=1e6"),
        ("material.layers[-1].medium.tau=1", "must be path=value, such as simulation.rays=1e6"),
        (
            "simulaton.rays=5",
            "leads nowhere: there is no simulaton (did you mean simulation.rays?)",
        ),
        (
            "material.layers[0].interfce.alpha=1",
            "leads nowhere: there is no material.layers[0].interfce (did you mean material.layers[0].interface.alpha?)",
        ),
        (
            "material.layers[3].medium.tau=1",
            "leads nowhere: material.layers has 3 entries, counted from 0",
        ),
        ("material.name[0]=a", "leads nowhere: material.name is no list"),
        ("material.name.first=a", "leads nowhere: material.name has no keys"),
        ("material.parts[0]=a", "leads nowhere: there is no material.parts"),
        (
            "simulation.ryas=5",
            "simulation.ryas: unknown key; the keys here are rays, target, max_rays, max_time, seed, estimator, "
            "orders and threads "
            "(did you mean rays?)",
        ),
        (
            "simulation.rays=",
            "simulation.rays: must be a whole number from 100 to 1e15, such as 1e7 [got nothing]",
        ),
        ("simulation.seed=x", "simulation.seed: must be a whole number from 0 to 2^63 - 1 [got 'x']"),
        ("slice.rows=[", "YAML syntax: expected the node content, but found '<stream end>'"),
        ("incident={}", "incident.theta_deg: is missing: this key is required"),
    ],
)
def test_a_wrong_override_is_named(assignment, line):
    with pytest.raises(ConfigError) as caught:
        parse_scene(SCENE, "file.yaml", [assignment])
    assert caught.value.problems == [f"override {assignment}: {line}"]


def test_all_wrong_overrides_are_named_in_order_after_the_file():
    with pytest.raises(ConfigError) as caught:
        parse_scene(SCENE, "f.yaml", ["a", "b"])
    assert [line.split(":")[0] for line in caught.value.problems] == ["override a", "override b"]
    with pytest.raises(ConfigError) as caught:
        parse_scene(SCENE.replace("1.5", "15"), "f.yaml", ["simulation.seed=-1", "simulation.rays=1"])
    assert [line.split(": ")[0] for line in caught.value.problems] == [
        "f.yaml:4",
        "override simulation.rays=1",
        "override simulation.seed=-1",
    ]


def test_studies_are_told_from_scenes(tmp_path):
    scene, study = write(tmp_path, SCENE), write(tmp_path, STUDY, "study.yaml")
    assert load_config(scene).study is None
    assert load_config(study).study == "two"
    assert load_config(study, ["study.name=three"]).study == "three"
    assert [each.material.name for each in load_scenes(study)] == ["a", "b"]


def test_one_scene_is_wanted_and_a_study_is_given(tmp_path):
    path = write(tmp_path, STUDY)
    with pytest.raises(ConfigError) as caught:
        load_scene(path)
    assert caught.value.problems == [
        f"{path}:1: study: describes several materials, and one is needed here: "
        "give a scene with material, or use load_scenes or simulate_study"
    ]
