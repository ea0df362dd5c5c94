"""Studies: lists and crossings of materials, and their mistakes."""

import pytest

from goniosim.errors import ConfigError
from goniosim.scene import load_scenes

CROSSED = """\
study:
  name: plastics
  cross:
    coat: [{alpha: 0.001, slice: half}, {alpha: 0.2, slice: classic}]
    body: [{label: P1, tau: [0.05, 0.1, 0.8], rho: 0.5}, {label: P4, tau: 0.2, rho: 0.6}]
    eta: [1.3, 1.5, 2]
  material:
    name: plastic-${body.label}-alpha0_${coat.alpha}-tau_${body.tau}-eta_${eta}
    layers:
      - interface: {type: dielectric, eta: "${eta}", alpha: "${ coat.alpha }"}
      - medium: {tau: "${body.tau}"}
      - interface: {type: lambert, rho: ["${body.rho}", 0.5, 0.5]}
incident:
  theta_deg: [0, 45]
slice: {parametrization: "${coat.slice}"}
"""

LISTED = """\
study:
  name: pair
  materials:
    - name: grey
      layers:
        - interface: {type: lambert, rho: 0.5}
    - name: mirror
      layers:
        - interface: {type: conductor, eta: 1, kappa: 9}
incident: {theta_deg: [0, 45]}
simulation: {rays: 1e5}
"""


def scenes(folder, text, overrides=()):
    path = folder / "study.yaml"
    path.write_text(text, encoding="utf-8")
    return load_scenes(path, overrides)


def mistakes(folder, text, overrides=()):
    with pytest.raises(ConfigError) as caught:
        scenes(folder, text, overrides)
    return [line.replace(f"{folder}/", "") for line in caught.value.problems]


def test_a_crossing_makes_every_combination_the_last_axis_fastest(tmp_path):
    made = scenes(tmp_path, CROSSED)
    assert [scene.material.name for scene in made] == [
        f"plastic-{label}-alpha0_{alpha}-tau_{tau}-eta_{eta}"
        for alpha in ("0.001", "0.2")
        for label, tau in (("P1", "0.05_0.1_0.8"), ("P4", "0.2"))
        for eta in ("1.3", "1.5", "2")
    ]


def test_a_lone_reference_keeps_the_type_of_its_value(tmp_path):
    first, *_, last = scenes(tmp_path, CROSSED)
    assert first.material.interfaces[0].model_dump() == {"type": "dielectric", "eta": 1.3, "alpha": 0.001}
    assert first.material.tau == ((0.05, 0.1, 0.8),)
    assert first.material.interfaces[1].rho == (0.5, 0.5, 0.5)
    assert first.slice.parametrization == "half"
    assert last.material.interfaces[0].model_dump() == {"type": "dielectric", "eta": 2.0, "alpha": 0.2}
    assert last.material.tau == ((0.2, 0.2, 0.2),)
    assert last.material.interfaces[1].rho == (0.6, 0.5, 0.5)
    assert last.slice.parametrization == "classic"
    assert {scene.incident.theta_deg for scene in scenes(tmp_path, CROSSED)} == {(0.0, 45.0)}


def test_an_axis_of_lists_is_an_axis_of_values(tmp_path):
    text = CROSSED.replace("eta: [1.3, 1.5, 2]", "eta: [1.5]\n    tau: [0.2, [0, 0.5, 1]]")
    text = text.replace("${body.tau}", "${tau}")
    made = scenes(tmp_path, text)
    assert [scene.material.tau[0] for scene in made[:2]] == [(0.2, 0.2, 0.2), (0.0, 0.5, 1.0)]
    assert made[1].material.name == "plastic-P1-alpha0_0.001-tau_0_0.5_1-eta_1.5"


def test_a_list_of_materials_shares_the_measurement(tmp_path):
    grey, mirror = scenes(tmp_path, LISTED)
    assert (grey.material.name, mirror.material.name) == ("grey", "mirror")
    assert grey.incident == mirror.incident
    assert grey.simulation.rays == mirror.simulation.rays == 100_000


def test_overrides_apply_before_the_study_is_expanded(tmp_path):
    overrides = [
        "simulation.rays=1e4",
        "study.cross.coat[1].alpha=0.5",
        "study.material.layers[1].medium.tau=0",
    ]
    made = scenes(tmp_path, CROSSED, overrides)
    assert {scene.simulation.rays for scene in made} == {10_000}
    assert {scene.material.interfaces[0].alpha for scene in made} == {0.001, 0.5}
    assert {scene.material.tau for scene in made} == {((0.0, 0.0, 0.0),)}


ETA = "must lie between 0.1 and 10: it is the absolute index below the interface"


@pytest.mark.parametrize(
    "old, new, lines",
    [
        (  # a wrong entry of an axis: the line of the template, and the materials that it spoils
            "eta: [1.3, 1.5, 2]",
            "eta: [1.3, 15]",
            [
                f"study.yaml:10: study.material.layers[0].interface.eta: {ETA} [got 15] "
                "(in material plastic-P1-alpha0_0.001-tau_0.05_0.1_0.8-eta_15 and 3 more)"
            ],
        ),
        (
            "eta: [1.3, 1.5, 2]",
            "eta: [13, 15]",
            [
                f"study.yaml:10: study.material.layers[0].interface.eta: {ETA} [got 13] "
                "(in material plastic-P1-alpha0_0.001-tau_0.05_0.1_0.8-eta_13 and 3 more)",
                f"study.yaml:10: study.material.layers[0].interface.eta: {ETA} [got 15] "
                "(in material plastic-P1-alpha0_0.001-tau_0.05_0.1_0.8-eta_15 and 3 more)",
            ],
        ),
        (  # a mistake of the template itself shows in every material and names none
            '"${eta}", alpha',
            "15, alpha",
            [f"study.yaml:10: study.material.layers[0].interface.eta: {ETA} [got 15]"],
        ),
        (
            "theta_deg",
            "thetadeg",
            [
                "study.yaml:13: incident.theta_deg: is missing: this key is required",
                "study.yaml:14: incident.thetadeg: unknown key; the keys here are theta_deg (did you mean theta_deg?)",
            ],
        ),
        (  # an entry of a list that a reference stands for
            "tau: 0.2,",
            "tau: [0.2, -1, 0],",
            [
                "study.yaml:11: study.material.layers[1].medium.tau[1]: must be 0 or more (1e9 at most): "
                "it is the optical depth, and 0 absorbs nothing [got -1] "
                "(in material plastic-P4-alpha0_0.001-tau_0.2_-1_0-eta_1.3 and 5 more)",
            ],
        ),
        (
            '"${body.tau}"',
            '"${boddy.tau}"',
            [
                "study.yaml:11: study.material.layers[1].medium.tau: ${boddy.tau} is unknown; the axes offer "
                "coat.alpha, coat.slice, body.label, body.tau, body.rho and eta (did you mean ${body.tau}?)"
            ],
        ),
        (
            '"${coat.slice}"',
            '"${coat.slice"',
            [
                "study.yaml:15: slice.parametrization: holds a ${ that is not closed: write ${axis} or "
                "${axis.key} [got '${coat.slice']"
            ],
        ),
        (
            '"${body.tau}"',
            "${body.tau}",
            ["study.yaml:11: YAML syntax: expected ',' or '}', but got '{': write ${...} between quotes"],
        ),
        (
            "-eta_${eta}",
            "",
            [
                f"study.yaml:8: study.material.name: two materials are named plastic-{rest}, "
                "and would share a file: give each material its own name"
                for rest in (
                    "P1-alpha0_0.001-tau_0.05_0.1_0.8",
                    "P4-alpha0_0.001-tau_0.2",
                    "P1-alpha0_0.2-tau_0.05_0.1_0.8",
                    "P4-alpha0_0.2-tau_0.2",
                )
            ],
        ),
        (
            "{alpha: 0.2, slice: classic}",
            "{alpha: 0.2, slize: classic}",
            [
                "study.yaml:4: study.cross.coat[1]: must be a mapping with alpha and slice, "
                "as the first entry of this axis is [got a mapping]"
            ],
        ),
        (
            "eta: [1.3, 1.5, 2]",
            "eta: [1.3, {low: 1, high: 2}]",
            [
                "study.yaml:6: study.cross.eta[1]: must be a value by itself, "
                "as the first entry of this axis is [got a mapping]"
            ],
        ),
        (
            "eta: [1.3, 1.5, 2]",
            "eta: []",
            ["study.yaml:6: study.cross.eta: must be a list of entries, with at least one [got []]"],
        ),
        (
            "eta: [1.3, 1.5, 2]",
            "eta: 1.5",
            ["study.yaml:6: study.cross.eta: must be a list of entries, with at least one [got 1.5]"],
        ),
        (
            "eta: [1.3, 1.5, 2]",
            "eta: [1.3, null]",
            ["study.yaml:6: study.cross.eta[1]: must be a number, text or a list of these [got nothing]"],
        ),
        (
            "eta: [1.3, 1.5, 2]",
            f"eta: {list(range(1, 2502))}",
            ["study.yaml:3: study.cross: gives 10004 materials, and 10000 is the limit: shorten an axis"],
        ),
        (
            "  name: plastics",
            "  name: my plastics",
            [
                "study.yaml:2: study.name: must be usable as a file name: 1 to 120 letters, digits or any of "
                ". _ + = - with no dot in front [got 'my plastics']"
            ],
        ),
        (
            "  name: plastics\n",
            "",
            ["study.yaml:1: study.name: is missing: this key is required"],
        ),
        (
            "  cross:",
            "  corss:",
            [
                "study.yaml:1: study.cross: is missing: this key is required",
                "study.yaml:3: study.corss: unknown key; the keys here are name, cross and material "
                "(did you mean cross?)",
            ],
        ),
        (
            "slice: {",
            "slices: {",
            [
                "study.yaml:15: slices: unknown key; the keys here are study, incident, slice and simulation "
                "(did you mean slice?)"
            ],
        ),
        (
            "incident:",
            "material: {name: a}\nincident:",
            [
                "study.yaml:13: material: is out of place beside study: "
                "use study.material with cross, or study.materials"
            ],
        ),
    ],
)
def test_mistakes_of_a_crossing(tmp_path, old, new, lines):
    assert old in CROSSED
    assert mistakes(tmp_path, CROSSED.replace(old, new)) == lines


@pytest.mark.parametrize(
    "old, new, lines",
    [
        (
            "rho: 0.5",
            "rho: 5",
            [
                "study.yaml:6: study.materials[0].layers[0].interface.rho: must lie between 0 and 1: "
                "it is the fraction of the light that the base sends back [got 5] (in material grey)"
            ],
        ),
        (
            "name: mirror",
            "name: Grey",
            [
                "study.yaml:7: study.materials[1].name: grey and Grey differ only in case, "
                "and would share a file: give each material its own name"
            ],
        ),
        (
            "    - name: mirror\n",
            "    - \n",
            ["study.yaml:8: study.materials[1].name: is missing: this key is required (in material number 2)"],
        ),
        (
            "rho: 0.5",
            'rho: "${rho}"',
            [
                "study.yaml:6: study.materials[0].layers[0].interface.rho: ${rho} is unknown; "
                "only a study with `cross` has axes"
            ],
        ),
        (
            "theta_deg: [0, 45]",
            "theta_deg: [0, 90]",
            [
                "study.yaml:10: incident.theta_deg[1]: must be 0 or more and below 90: "
                "it is the angle from the normal in degrees [got 90]"
            ],
        ),
        (
            "  name: pair\n",
            "  name: pair\n  cross: {a: [1]}\n",
            [
                "study.yaml:1: study.material: is missing: this key is required",
                "study.yaml:4: study.materials: unknown key; the keys here are name, cross and material "
                "(did you mean material?)",
            ],
        ),
    ],
)
def test_mistakes_of_a_list(tmp_path, old, new, lines):
    assert old in LISTED
    assert mistakes(tmp_path, LISTED.replace(old, new)) == lines


@pytest.mark.parametrize(
    "text, lines",
    [
        (
            "study:\n",
            [
                "study.yaml:1: study: must be a mapping with name and materials, "
                "or with name, cross and material [got nothing]"
            ],
        ),
        (
            "study: {name: a, materials: []}\n",
            ["study.yaml:1: study.materials: must be a list of materials, with at least one [got []]"],
        ),
        (
            "study: {name: a, cross: [1], material: {}}\n",
            [
                "study.yaml:1: study.cross: must be a mapping from the name of an axis to the list of its "
                "entries [got [1]]"
            ],
        ),
        (
            "study: {name: a, cross: {x: [1]}, material: 5}\nincident: {theta_deg: [0]}\n",
            ["study.yaml:1: study.material: must be a mapping with name and layers [got 5]"],
        ),
    ],
)
def test_mistakes_of_form(tmp_path, text, lines):
    assert mistakes(tmp_path, text) == lines


def test_an_override_of_a_study_that_would_suit_a_scene(tmp_path):
    assert mistakes(tmp_path, CROSSED, ["material.name=a"]) == [
        "override material.name=a: material: is out of place beside study: "
        "use study.material with cross, or study.materials"
    ]
    wrong = mistakes(tmp_path, CROSSED, ["study.cross.eta[1]=-1"])
    assert wrong == [
        f"study.yaml:10: study.material.layers[0].interface.eta: {ETA} [got -1] "
        "(in material plastic-P1-alpha0_0.001-tau_0.05_0.1_0.8-eta_-1 and 3 more)"
    ]
