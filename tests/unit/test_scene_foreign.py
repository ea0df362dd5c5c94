"""Scenes in the words of other tools: a hint by meaning for each word, and all that is wrong at once."""

import math

import pytest

from goniosim.errors import ConfigError
from goniosim.scene import load_scenes, parse_scene
from goniosim.scene.foreign import translate
from goniosim.scene.foreign.words import KEYS, TYPES, normal
from goniosim.scene.layers import INTERFACES, Layer, Medium
from goniosim.scene.model import Incident, Material, Scene, Simulation, Slice
from goniosim.scene.target import Target
from goniosim.scene.tree import Origin, from_plain

PLACES = {
    "scene": Scene,
    "material": Material,
    "layer": Layer,
    "medium": Medium,
    "incident": Incident,
    "slice": Slice,
    "simulation": Simulation,
    "target": Target,
    **INTERFACES,
}

SCENE = """\
material:
  name: patina
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - medium: {tau: 0.5}
    - interface: {type: conductor, eta: 1.45, kappa: 1.0, alpha: 0.2}
    - interface: {type: lambert, rho: 0.5}
incident: {theta_deg: [0, 30]}
slice: {parametrization: classic}
simulation: {rays: 1e7, seed: 1}
"""
# A lambert base below a conductor: what is said about it is left out below.
OPAQUE = "must be the last layer"
COAT, MEDIUM, METAL, BASE = (
    f"f.yaml:{line}: material.layers[{line - 4}].{kind}"
    for line, kind in ((4, "interface"), (5, "medium"), (6, "interface"), (7, "interface"))
)
ETA = "unknown key; eta is the absolute refractive index below the interface"
ALPHA = "unknown key; alpha is the GGX width, alpha = roughness^2"
TAU = "unknown key; tau is the optical depth of one crossing, tau = sigma_a * thickness"
RAYS = "unknown key; rays is the number of rays for each incident direction"
THETA = "unknown key; theta_deg lists the angles of incidence from the normal, in degrees"
TYPE = "must be dielectric, conductor or lambert"


def problems_of(text, source="f.yaml"):
    with pytest.raises(ConfigError) as caught:
        parse_scene(text, source)
    return [line for line in caught.value.problems if OPAQUE not in line]


@pytest.mark.parametrize(
    "old, new, lines",
    [
        # what is called otherwise, with its value worked out
        ("eta: 1.5,", "ior: 1.5,", [f"{COAT}.ior: {ETA} (did you mean eta: 1.5?)"]),
        ("eta: 1.5,", "int_ior: 1.5,", [f"{COAT}.int_ior: {ETA} (did you mean eta: 1.5?)"]),
        ("eta: 1.5,", "intIOR: 1.5,", [f"{COAT}.intIOR: {ETA} (did you mean eta: 1.5?)"]),
        ("eta: 1.45", "n: [1, 2, 3]", [f"{METAL}.n: {ETA} (did you mean eta: [1, 2, 3]?)"]),
        ("alpha: 0.2}", "roughness: 0.3}", [f"{COAT}.roughness: {ALPHA} (did you mean alpha: 0.09?)"]),
        ("alpha: 0.2}", "roughness: -1}", [f"{COAT}.roughness: {ALPHA} (did you mean alpha?)"]),
        (
            "rays: 1e7",
            "rays_per_direction: 1e2",
            [f"f.yaml:10: simulation.rays_per_direction: {RAYS} (did you mean rays: 100?)"],
        ),
        (
            "alpha: 0.2}",
            "glossiness: 0.7}",
            [
                f"{COAT}.glossiness: unknown key; alpha is the GGX width, alpha = (1 - glossiness)^2 "
                "(did you mean alpha: 0.09?)"
            ],
        ),
        (
            "kappa: 1.0",
            "k: 3.9",
            [
                f"{METAL}.k: unknown key; kappa is the imaginary part of the absolute refractive index "
                "(did you mean kappa: 3.9?)"
            ],
        ),
        (
            "tau: 0.5",
            "sigma_a: [0.1, 0.2, 0.3], thickness: 2",
            [
                f"{MEDIUM}.sigma_a: {TAU} (did you mean tau: [0.2, 0.4, 0.6]?)",
                f"{MEDIUM}.thickness: {TAU} (did you mean tau: [0.2, 0.4, 0.6]?)",
            ],
        ),
        ("tau: 0.5", "thickness: 2", [f"{MEDIUM}.thickness: {TAU} (did you mean tau?)"]),
        (
            "tau: 0.5",
            "transmittance: 0.5",
            [
                f"{MEDIUM}.transmittance: unknown key; tau is the optical depth of one crossing, "
                "tau = -ln(transmittance) (did you mean tau: 0.693147?)"
            ],
        ),
        (
            "rho: 0.5",
            "reflectance: 0.5",
            [
                f"{BASE}.reflectance: unknown key; rho is the fraction of the light that a lambert base sends back "
                "(did you mean rho: 0.5?)"
            ],
        ),
        ("theta_deg: [0, 30]", "theta: 30", [f"f.yaml:8: incident.theta: {THETA} (did you mean theta_deg: [30]?)"]),
        (
            "theta_deg: [0, 30]",
            "theta_rad: [0, 0.5]",
            [f"f.yaml:8: incident.theta_rad: {THETA}, 180/pi of a radian (did you mean theta_deg: [0, 28.6479]?)"],
        ),
        ("rays: 1e7", "spp: 1e5", [f"f.yaml:10: simulation.spp: {RAYS} (did you mean rays: 100000?)"]),
        (
            "seed: 1",
            "workers: 2",
            ["f.yaml:10: simulation.workers: unknown key; each thread uses a core (did you mean threads: 2?)"],
        ),
        (
            "simulation: {rays: 1e7, seed: 1}",
            "sampling: {samples: 1e5}",
            [
                "f.yaml:10: sampling: unknown key; rays and seed belong to simulation (did you mean simulation?)",
                f"f.yaml:10: sampling.samples: {RAYS} (did you mean rays: 100000?)",
            ],
        ),
        (
            "interface: {type: conductor, eta: 1.45, kappa: 1.0, alpha: 0.2}",
            "conductor: {eta: 1.45, kappa: 1.0, alpha: 0.2}",
            [
                "f.yaml:6: material.layers[2].conductor: unknown key; write `- interface: {type: ..., ...}`",
            ],
        ),
        (
            "medium: {tau: 0.5}",
            "{sigma_a: 0.5, thickness: 1}",
            [
                "f.yaml:5: material.layers[1].sigma_a: unknown key; "
                "absorption belongs to a medium: write `- medium: {tau: ...}`",
                "f.yaml:5: material.layers[1].thickness: unknown key; "
                "absorption belongs to a medium: write `- medium: {tau: ...}`",
            ],
        ),
        # types
        (
            "type: conductor",
            "type: metal",
            [
                f"{METAL}.type: {TYPE}; a metal is a conductor, of absolute index eta + i kappa [got 'metal'] "
                "(did you mean conductor?)"
            ],
        ),
        (
            "type: lambert",
            "type: diffuse",
            [f"{BASE}.type: {TYPE}; a diffuse base is called lambert [got 'diffuse'] (did you mean lambert?)"],
        ),
        (
            "type: dielectric",
            "type: rough-dielectric",
            [
                f"{COAT}.type: {TYPE}; what lets light in is a dielectric, rough by its alpha "
                "[got 'rough-dielectric'] (did you mean dielectric?)"
            ],
        ),
        (
            "{type: lambert, rho: 0.5}",
            "{type: plastic, int_ior: 1.5}",
            [f"{BASE}.type: {TYPE}; a plastic is two layers, a dielectric coat over a lambert base [got 'plastic']"],
        ),
        # what is not there
        (
            "eta: 1.5,",
            "eta: 1.5, alpha_x: 1,",
            [f"{COAT}.alpha_x: not available: roughness is the same in all directions; give one alpha"],
        ),
        (
            "eta: 1.5,",
            "eta: 1.5, distribution: beckmann,",
            [
                f"{COAT}.distribution: not available: a choice of distribution; every rough interface is GGX: "
                "remove this key"
            ],
        ),
        ("tau: 0.5", "tau: 0.5, g: 0.9", [f"{MEDIUM}.g: not available: media absorb and do not scatter; give tau"]),
        (
            "[0, 30]}",
            "[0, 30], phi_deg: 0}",
            [
                "f.yaml:8: incident.phi_deg: not available: layers look the same from every azimuth, "
                "and the light stands at phi = 0"
            ],
        ),
        (
            "eta: 1.5,",
            "eta: 1.5, k: 0.1,",
            [
                f"{COAT}.k: unknown key; a dielectric does not absorb; put a medium with tau below it, "
                "or use a conductor"
            ],
        ),
        # values
        (
            "eta: 1.5,",
            "eta: glass,",
            [
                f"{COAT}.eta: must be a number, and lie between 0.1 and 10: it is the absolute index below the "
                "interface; no materials are known by name [got 'glass'] (did you mean 1.5?)"
            ],
        ),
        (
            "eta: 1.45",
            "eta: gold",
            [
                f"{METAL}.eta: must be a number, and lie between 0.001 and 1000: it is the real part of the absolute "
                "index; no materials are known by name, so look up the index for red, green and blue [got 'gold']"
            ],
        ),
        (
            "eta: 1.45",
            "eta: 1.45 + 1i",
            [
                f"{METAL}.eta: must be a number, and lie between 0.001 and 1000: it is the real part of the absolute "
                "index; an index has two keys here [got '1.45 + 1i'] (did you mean eta: 1.45 and kappa: 1?)"
            ],
        ),
        (
            "classic",
            "rusinkiewicz",
            ["f.yaml:9: slice.parametrization: must be classic or half [got 'rusinkiewicz'] (did you mean half?)"],
        ),
        # decimal commas, as text and where they end an entry
        ("tau: 0.5", 'tau: "0,5"', [f"{MEDIUM}.tau: must be a number without a comma: write 0.5 [got '0,5']"]),
        (
            "tau: 0.5",
            "tau: 1,5",
            [f"{MEDIUM}.5: a comma separates entries here: write tau: 1.5, with a decimal point"],
        ),
        (
            "rays: 1e7",
            'rays: "1,000,000"',
            ["f.yaml:10: simulation.rays: must be a number without a comma: write 1000000 [got '1,000,000']"],
        ),
        (
            "tau: 0.5",
            "tau: [0,5, 0,25, 1,0]",
            [
                f"{MEDIUM}.tau: must be one number for all channels or a list of three, for R, G and B: "
                "this list has 6; a comma ends a number, so write 0.5 and not 0,5 [got [0, 5, 0, 25, 1, 0]]"
            ],
        ),
        # what was meant is checked as well
        (
            "eta: 1.5,",
            "ior: 15,",
            [
                f"{COAT}.ior: {ETA} (did you mean eta?)",
                f"{COAT}.ior: must lie between 0.1 and 10: it is the absolute index below the interface [got 15]",
            ],
        ),
        (
            "type: dielectric, eta: 1.5,",
            "ior: 1.5,",
            [
                f"{COAT}.ior: {ETA} (did you mean eta: 1.5?)",
                f"{COAT}.type: is missing: give one of dielectric, conductor or lambert",
            ],
        ),
    ],
)
def test_a_foreign_word_is_told_by_its_meaning(old, new, lines):
    assert old in SCENE
    assert problems_of(SCENE.replace(old, new, 1)) == lines


def test_a_whole_scene_of_another_tool_is_mended_by_its_hints_alone():
    text = """\
material:
  id: rough
  layers:
    - coating: {type: roughdielectric, int_ior: 1.5, roughness: 0.3}
    - volume: {sigma_a: 0.2, thickness: 3}
    - interface: {type: metal, n: 0.2, k: 3.9, alpha: 0.3}
light: {angles: 0}
settings: {samples: 1e5, cores: 2}
"""
    assert len(problems_of(text)) == 16
    for old, new in (
        ("id", "name"),
        ("coating", "interface"),
        ("roughdielectric", "dielectric"),
        ("int_ior: 1.5", "eta: 1.5"),
        ("roughness: 0.3", "alpha: 0.09"),
        ("volume", "medium"),
        ("sigma_a: 0.2, thickness: 3", "tau: 0.6"),
        ("metal", "conductor"),
        ("n: 0.2", "eta: 0.2"),
        ("k: 3.9", "kappa: 3.9"),
        ("light", "incident"),
        ("angles: 0", "theta_deg: [0]"),
        ("settings", "simulation"),
        ("samples: 1e5", "rays: 100000"),
        ("cores", "threads"),
    ):
        assert old in text
        text = text.replace(old, new, 1)
    assert parse_scene(text).material.interfaces[0].alpha == 0.09


def test_overrides_get_the_same_hints():
    with pytest.raises(ConfigError) as caught:
        parse_scene(SCENE.replace("    - interface: {type: lambert, rho: 0.5}\n", ""), "f.yaml", [
            "simulation.samples=1e5",
            "material.layers[1].medium.tau=1,5",
        ])  # fmt: skip
    assert [line.split(": ", 1)[1] for line in caught.value.problems] == [
        f"simulation.samples: {RAYS} (did you mean rays: 100000?)",
        "material.layers[1].medium.tau: must be a number without a comma: write 1.5 [got '1,5']",
    ]


def test_studies_get_the_same_hints(tmp_path):
    path = tmp_path / "study.yaml"
    path.write_text("""\
study:
  name: coats
  sweep: {roughness: [0.1, 0.2]}
  material: {}
light: {}
""")
    with pytest.raises(ConfigError) as caught:
        load_scenes(path)
    assert caught.value.problems == [
        f"{path}:1: study.cross: is missing: this key is required",
        f"{path}:3: study.sweep: unknown key; the axes of a study are crossed (did you mean cross?)",
        f"{path}:5: light: unknown key; the light is called incident (did you mean incident?)",
    ]
    path.write_text("""\
study:
  name: coats
  cross: {r: [0.1, 0.2]}
  material:
    name: coat-${r}
    layers:
      - interface: {type: dielectric, ior: 1.5, roughness: "${r}"}
incident: {theta_deg: [0]}
""")
    with pytest.raises(ConfigError) as caught:
        load_scenes(path)
    place = f"{path}:7: study.material.layers[0].interface"
    assert caught.value.problems == [
        f"{place}.ior: {ETA} (did you mean eta: 1.5?)",
        f"{place}.roughness: {ALPHA} (did you mean alpha: 0.01?) (in material coat-0.1)",
        f"{place}.roughness: {ALPHA} (did you mean alpha: 0.04?) (in material coat-0.2)",
    ]


def test_the_table_leads_to_keys_that_exist_and_shadows_none():
    for place, meanings in KEYS.items():
        if place == "study":
            known = {"name", "cross", "material", "materials"}
        elif place in ("interface", "type"):
            known = {key for kind in INTERFACES.values() for key in kind.model_fields}
        else:
            known = set(PLACES[place].model_fields)
        words = [normal(word) for meaning in meanings for word in meaning.words.split()]
        assert {meaning.key for meaning in meanings} - {None} <= known, place
        assert len(words) == len(set(words)), sorted(words)
        if place not in ("interface", "scene"):
            assert not set(words) & set(map(normal, known)), place
    assert {kind for kind, _, _ in TYPES} - {None} == set(INTERFACES)


def test_nothing_under_a_foreign_word_trips_it():
    """A word of every meaning at every place, over whatever YAML or Python may hold."""
    junk = [None, True, -1, 10**5000, 1e300, math.nan, math.inf, "x", "", "1,5", [], [[1], [2, None]], {}, {"5": None}]
    noted = 0
    for word in [meaning.words.split()[0] for meanings in KEYS.values() for meaning in meanings]:
        for value in junk:
            part = {word: value, "type": "metal", "thickness": value, "target": {word: value}}
            layers = [{"interface": part}, {"medium": part}, part]
            scene = {**part, "material": {**part, "layers": layers}}
            scene |= dict.fromkeys(("incident", "slice", "simulation"), part)
            _, problems = translate(from_plain(scene, Origin("f.yaml", 1)))
            noted += len(list(map(str, problems)))
    assert noted > 1000
