"""The configurations that come with goniosim, and the JSON Schema for editors."""

import json
import re
from pathlib import Path

import jsonschema
import pytest

from goniosim.scene import json_schema, load_config, load_scene, load_scenes
from goniosim.scene.reading import read_file, read_text
from goniosim.scene.schema import schema_text
from goniosim.scene.tree import plain

CONFIGS = Path(__file__).resolve().parents[2] / "configs"
SCHEMA_FILE = CONFIGS / "scene.schema.json"
FILES = sorted(CONFIGS.rglob("*.yaml"))

TAU = {"C": (0.05, 0.1, 0.8), "A": (0.2, 0.2, 0.2)}
RHO = {"C": (0.1, 0.6, 0.1), "A": (0.5, 0.5, 0.5)}
TAU_NAME = {"C": "0.05_0.1_0.8", "A": "0.2"}
RHO_NAME = {"C": "0.1_0.6_0.1", "A": "0.5"}
COATS = (0.001, 0.05, 0.2)

# Tables 3 to 5 of Bati et al. 2019, written out here a second time.
PLASTICS = {"P1": ("C", "C"), "P2": ("C", "A"), "P3": ("A", "C"), "P4": ("A", "A")}
METALS = {
    "M1": ("C", 1.9),
    "M2": ("C", 1.45),
    "M3": ("A", 1.9),
    "M4": ("A", 1.45),
    "M5": ("C", 1.2),
    "M6": ("A", 1.2),
}
SLABS = {"S1": ("C", 0.2), "S2": ("A", 0.2), "S3": ("C", 0.001), "S4": ("A", 0.001)}


def paper(name):
    return load_scenes(CONFIGS / "paper" / f"{name}.yaml")


def coat_of(scene):
    """The coat's alpha, once everything that all 60 materials share has been checked."""
    coat = scene.material.interfaces[0]
    assert len(scene.material.interfaces) == 2
    assert (coat.type, coat.eta) == ("dielectric", 1.5)
    assert scene.incident.theta_deg == (0, 15, 30, 45, 60, 75, 85)
    assert scene.simulation.rays == 160_000_000
    assert (scene.slice.rows, scene.slice.columns) == (90, 360)
    assert scene.slice.parametrization == ("classic" if coat.alpha == 0.2 else "half")
    return coat.alpha


def test_plastics_are_those_of_the_paper():
    expected = {
        f"{label}-alpha0_{alpha}-tau_{TAU_NAME[tau]}-rho_{RHO_NAME[rho]}": (alpha, TAU[tau], RHO[rho])
        for label, (tau, rho) in PLASTICS.items()
        for alpha in COATS
    }
    found = {}
    for scene in paper("plastics"):
        base = scene.material.interfaces[1]
        assert base.type == "lambert"
        found[scene.material.name] = (coat_of(scene), scene.material.tau[0], base.rho_rgb)
    assert found == expected
    assert len(found) == 12


def test_metals_are_those_of_the_paper():
    expected = {
        f"{label}-alpha0_{alpha}-alpha1_{alpha1}-tau_{TAU_NAME[tau]}-eta1_{eta}": (
            alpha,
            alpha1,
            TAU[tau],
            eta,
        )
        for label, (tau, eta) in METALS.items()
        for alpha in COATS
        for alpha1 in (0.001, 0.2)
    }
    found = {}
    for scene in paper("metals"):
        base = scene.material.interfaces[1]
        assert (base.type, base.kappa) == ("conductor", (1.0, 0.01, 0.01))
        found[scene.material.name] = (coat_of(scene), base.alpha, scene.material.tau[0], base.eta)
    assert found == expected
    assert len(found) == 36


def test_slabs_are_those_of_the_paper():
    expected = {
        f"{label}-alpha0_{alpha}-alpha1_{alpha1}-tau_{TAU_NAME[tau]}": (alpha, alpha1, TAU[tau])
        for label, (tau, alpha1) in SLABS.items()
        for alpha in COATS
    }
    found = {}
    for scene in paper("slabs"):
        base = scene.material.interfaces[1]
        assert (base.type, base.eta) == ("dielectric", 1.0)
        assert scene.material.transmits
        found[scene.material.name] = (coat_of(scene), base.alpha, scene.material.tau[0])
    assert found == expected
    assert len(found) == 12


def test_studies_are_named_after_their_files():
    names = {path.stem: load_config(path).study for path in FILES}
    assert names == {"quickstart": None, "plastics": "plastics", "metals": "metals", "slabs": "slabs"}


def test_quickstart_is_the_metallic_patina():
    scene = load_scene(CONFIGS / "quickstart.yaml")
    assert scene.material.name == "metallic-patina"
    assert [face.model_dump() for face in scene.material.interfaces] == [
        {"type": "dielectric", "eta": 1.5, "alpha": 0.2},
        {"type": "conductor", "eta": 1.45, "kappa": (1.0, 0.01, 0.01), "alpha": 0.2},
    ]
    assert scene.material.tau == ((0.05, 0.1, 0.8),)
    assert scene.incident.theta_deg == (0, 15, 30, 45, 60, 75, 85)
    assert scene.slice.model_dump() == {"parametrization": "classic", "rows": 90, "columns": 360}
    assert (scene.simulation.rays, scene.simulation.seed) == (200_000, 1)


def test_the_schema_file_is_that_of_the_code():
    # To write it anew: put schema_text() of goniosim.scene.schema into the file.
    assert SCHEMA_FILE.read_text(encoding="utf-8") == schema_text()
    jsonschema.Draft202012Validator.check_schema(json_schema())


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_configuration_satisfies_the_schema_and_points_to_it(path):
    first = path.read_text(encoding="utf-8").splitlines()[0]
    pointer = re.fullmatch(r"# yaml-language-server: \$schema=(\S+)", first)[1]
    assert (path.parent / pointer).resolve() == SCHEMA_FILE
    schema = json.loads(SCHEMA_FILE.read_text(encoding="utf-8"))
    jsonschema.validate(plain(read_file(path)), schema, jsonschema.Draft202012Validator)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_what_a_scene_writes_satisfies_the_schema(path):
    validator = jsonschema.Draft202012Validator(json_schema())
    for scene in load_scenes(path):
        validator.validate(plain(read_text(scene.to_yaml(), "written")))


@pytest.mark.parametrize(
    "name, old, new",
    [
        ("quickstart", "eta: 1.5", "eta: 15"),
        ("quickstart", "eta: 1.5, alpha: 0.2", "eta: 1.5, alpha: 1e-9"),
        ("quickstart", "eta: 1.5", "etta: 1.5"),
        ("quickstart", "eta: 1.5, ", ""),
        ("quickstart", "dielectric", "dielectrc"),
        ("quickstart", "[0.05, 0.1, 0.8]", "[0.05, 0.1]"),
        ("quickstart", "[0.05, 0.1, 0.8]", "-1"),
        ("quickstart", "[0.05, 0.1, 0.8]", '"${tau}"'),
        ("quickstart", "- medium: {", "- medium: {tau: 1}\n      interface: {"),
        ("quickstart", "name: metallic-patina", "name: .hidden"),
        ("quickstart", "[0, 15", "[0, 0, 15"),
        ("quickstart", "85]", "90]"),
        ("quickstart", "classic", "clasic"),
        ("quickstart", "rays: 2e5", "rays: 4.5"),
        ("quickstart", "seed: 1", "seed: -1"),
        ("quickstart", "incident:", "incidents:"),
        ("paper/plastics", "  name: plastics\n", ""),
        ("paper/plastics", "cross:", "corss:"),
        ("paper/plastics", "eta: 1.5", "eta: 15"),
        ("paper/plastics", "rho: 0.5", "rho: null"),
        ("paper/plastics", "incident:", "material: {}\nincident:"),
    ],
)
def test_the_schema_refuses_what_goniosim_refuses(name, old, new):
    text = (CONFIGS / f"{name}.yaml").read_text(encoding="utf-8")
    assert old in text
    content = plain(read_text(text.replace(old, new, 1), "changed"))
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(content, json_schema(), jsonschema.Draft202012Validator)
