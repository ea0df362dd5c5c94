"""The identity of a scene, and the words for what two scenes differ in."""

import pytest

from goniosim.scene import differences, parse_scene

SCENE = """\
material:
  name: small
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - medium: {tau: 0.2}
    - interface: {type: conductor, eta: 1.45, kappa: [1.0, 0.01, 0.01], alpha: 0.2}
incident: {theta_deg: [0, 30]}
"""

SAME = [
    ("alpha: 0.2}\n    - medium", "alpha: 2.0e-1}\n    - medium"),
    ("{tau: 0.2}", "{tau: [0.2, 0.20, 2e-1]}"),
    ("    - medium: {tau: 0.2}\n", "    - medium: {tau: 0.125}\n    - medium: {tau: 0.075}\n"),
    ("{type: dielectric, eta: 1.5, alpha: 0.2}", "{alpha: 0.2, eta: 1.5, type: dielectric}"),
    ("[0, 30]", "[-0.0, 3.0e+1]"),
    ("[0, 30]}\n", "[0, 30]}\nsimulation: {estimator: auto, threads: 3, rays: 100, seed: 1}\nslice: {rows: 90}\n"),
    ("[0, 30]}\n", "[0, 30]}\nsimulation: {target: {relative_error: 1%, of: cells}, max_rays: 1e6, max_time: 1h}\n"),
    ("name: small", "name: large"),
]


@pytest.mark.parametrize("edit", SAME)
def test_what_is_no_difference(edit):
    """Equal numbers written otherwise, the order of keys, defaults left out or not; and after a round trip."""
    scene, other = parse_scene(SCENE), parse_scene(SCENE.replace(*edit))
    assert SCENE.replace(*edit) != SCENE
    assert other.config_hash() == scene.config_hash() == parse_scene(other.to_yaml()).config_hash()
    assert differences(scene, other) == differences(other, scene) == []


DIFFERENT = [
    ("eta: 1.5", "eta: 1.6", "layers[0].interface.eta: 1.5 in the file, 1.6 asked for"),
    ("eta: 1.5", "eta: 1.5000000000000002", "layers[0].interface.eta: 1.5 in the file, 1.5000000000000002 asked for"),
    ("{tau: 0.2}", "{tau: [0.2, 0.2, 0.3]}", "layers[1].medium.tau: 0.2 in the file, [0.2, 0.2, 0.3] asked for"),
    (
        "{type: conductor, eta: 1.45, kappa: [1.0, 0.01, 0.01], alpha: 0.2}",
        "{type: lambert, rho: 1}",
        "layers[2]: conductor in the file, lambert asked for",
    ),
    (
        "    - medium: {tau: 0.2}\n",
        "",
        "layers: dielectric, medium, conductor in the file, dielectric, conductor asked for",
    ),
    ("[0, 30]", "[30, 0]", "incident.theta_deg: [0, 30] in the file, [30, 0] asked for"),
    ("30]}\n", "30]}\nslice: {parametrization: half}\n", "slice.parametrization: classic in the file, half asked for"),
    ("30]}\n", "30]}\nsimulation: {seed: 2}\n", "simulation.seed: 1 in the file, 2 asked for"),
    (
        "30]}\n",
        "30]}\nsimulation: {estimator: analog}\n",
        "simulation.estimator: auto in the file, analog asked for",
    ),
    ("30]}\n", "30]}\nsimulation: {orders: 3}\n", "simulation.orders: nothing in the file, 3 asked for"),
]


@pytest.mark.parametrize(("old", "new", "line"), DIFFERENT)
def test_each_difference_is_named(old, new, line):
    scene, other = parse_scene(SCENE), parse_scene(SCENE.replace(old, new))
    assert differences(scene, other) == [line]
    assert scene.config_hash() != other.config_hash()


def test_of_many_angles_the_first_that_differs_is_named():
    def lit(angles):
        return parse_scene(SCENE.replace("[0, 30]", str(list(angles))))

    line = "incident.theta_deg[40]: 40 in the file, 88.5 asked for"
    assert differences(lit(range(80)), lit([*range(40), 88.5, *range(41, 80)])) == [line]
    assert differences(lit(range(80)), lit(range(79))) == [
        "incident.theta_deg: 80 angles in the file, 79 angles asked for"
    ]


def test_media_written_otherwise_are_no_difference_beside_another_one():
    split = SCENE.replace("    - medium: {tau: 0.2}\n", "    - medium: {tau: 0.125}\n    - medium: {tau: 0.075}\n")
    other = parse_scene(split + "simulation: {seed: 2}\n")
    assert differences(parse_scene(SCENE), other) == ["simulation.seed: 1 in the file, 2 asked for"]
