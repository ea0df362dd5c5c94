"""Every refusal of a scene file: its line, its field, its sentence."""

import pytest

from goniosim.errors import ConfigError
from goniosim.scene import parse_scene

SCENE = """\
material:
  name: patina
  layers:
    - interface: {type: dielectric, eta: 1.5, alpha: 0.2}
    - medium: {tau: [0.05, 0.1, 0.8]}
    - interface:
        type: conductor
        eta: 1.45
        kappa: [1.0, 0.01, 0.01]
        alpha: 0.2
incident:
  theta_deg: [0, 15, 30]
slice: {parametrization: classic}
simulation: {rays: 1e7, seed: 1}
"""

ALPHA = "must be 0 or lie between 1e-6 and 1: it is the GGX width; use 0 for a smooth interface"
ETA = "lie between 0.1 and 10: it is the absolute index below the interface"
ETA1 = "lie between 0.001 and 1000: it is the real part of the absolute index"
KAPPA = "lie between 0 and 1e6: it is the imaginary part of the absolute index"
TAU = "be 0 or more (1e9 at most): it is the optical depth, and 0 absorbs nothing"
THETA = "be 0 or more and below 90: it is the angle from the normal in degrees"
RAYS = "must be a whole number from 100 to 1e15, such as 1e7"
SEED = "must be a whole number from 0 to 2^63 - 1"
NAME = "must be usable as a file name: 1 to 120 letters, digits or any of . _ + = - with no dot in front"
CHANNELS = "must be one number for all channels or a list of three, for R, G and B: this list has"
MISSING = "is missing: this key is required"
COAT = "f.yaml:4: material.layers[0].interface"


@pytest.mark.parametrize(
    "old, new, line",
    [
        # numbers out of range, of the wrong type, or no numbers
        ("eta: 1.5,", "eta: 0,", f"{COAT}.eta: must {ETA} [got 0]"),
        ("eta: 1.5,", "eta: 0.09,", f"{COAT}.eta: must {ETA} [got 0.09]"),
        ("eta: 1.5,", "eta: 10.1,", f"{COAT}.eta: must {ETA} [got 10.1]"),
        ("eta: 1.5,", "eta: true,", f"{COAT}.eta: must be a number, and {ETA} [got true]"),
        ("eta: 1.5,", "eta: ,", f"{COAT}.eta: must be a number, and {ETA} [got nothing]"),
        (
            "eta: 1.5,",
            "eta: [1, 2, 3],",
            f"{COAT}.eta: must be a number, and {ETA}; an index for each channel is not available in a dielectric "
            "[got [1, 2, 3]]",
        ),
        ("eta: 1.5,", "eta: {a: 1},", f"{COAT}.eta: must be a number, and {ETA} [got a mapping]"),
        ("eta: 1.5,", "eta: .nan,", f"{COAT}.eta: must be finite, and {ETA} [got nan]"),
        ("eta: 1.5,", "eta: -.inf,", f"{COAT}.eta: must be finite, and {ETA} [got -inf]"),
        ("eta: 1.5,", "eta: 1e999,", f"{COAT}.eta: must be finite, and {ETA} [got inf]"),
        (
            "eta: 1.5,",
            "eta: '1.5',",
            f"{COAT}.eta: must be a number, and it is text here: write it without quotes [got '1.5']",
        ),
        ("alpha: 0.2}", "alpha: 1.01}", f"{COAT}.alpha: {ALPHA} [got 1.01]"),
        ("alpha: 0.2}", "alpha: -0.1}", f"{COAT}.alpha: {ALPHA} [got -0.1]"),
        ("alpha: 0.2}", "alpha: 9e-7}", f"{COAT}.alpha: {ALPHA} [got 9e-07]"),
        ("eta: 1.45", "eta: 0", f"f.yaml:8: material.layers[2].interface.eta: must {ETA1} [got 0]"),
        (
            "eta: 1.45",
            "eta: [1, 2]",
            f"f.yaml:8: material.layers[2].interface.eta: {CHANNELS} 2 [got [1, 2]]",
        ),
        (
            "[1.0, 0.01,",
            "[1.0, -1,",
            f"f.yaml:9: material.layers[2].interface.kappa[1]: must {KAPPA} [got -1]",
        ),
        ("[0.05, 0.1, 0.8]", "-0.1", f"f.yaml:5: material.layers[1].medium.tau: must {TAU} [got -0.1]"),
        (
            "[0.05,",
            "[.inf,",
            f"f.yaml:5: material.layers[1].medium.tau[0]: must be finite, and {TAU} [got inf]",
        ),
        (
            "[0.05, 0.1, 0.8]",
            "[]",
            f"f.yaml:5: material.layers[1].medium.tau: {CHANNELS} 0 [got []]",
        ),
        ("[0, 15, 30]", "[0, 90]", f"f.yaml:12: incident.theta_deg[1]: must {THETA} [got 90]"),
        ("[0, 15, 30]", "[-1]", f"f.yaml:12: incident.theta_deg[0]: must {THETA} [got -1]"),
        (
            "[0, 15, 30]",
            "[0, 15, 0.0]",
            "f.yaml:12: incident.theta_deg[2]: must differ from the angles before it: remove it [got 0.0]",
        ),
        (
            "[0, 15, 30]",
            "[]",
            "f.yaml:12: incident.theta_deg: must hold at least one angle, such as [45] [got []]",
        ),
        (
            "[0, 15, 30]",
            "45",
            "f.yaml:12: incident.theta_deg: must be a list of angles in degrees: write [45] [got 45]",
        ),
        (
            "[0, 15, 30]",
            "95",
            "f.yaml:12: incident.theta_deg: must be a list of angles in degrees, such as [0, 30, 60] [got 95]",
        ),
        (
            "rays: 1e7",
            "target: 2 %",
            "f.yaml:14: simulation.target: must be a mapping with relative_error and of: "
            "write target: {relative_error: 2 %} [got '2 %']",
        ),
        (
            "rays: 1e7",
            "target: 0.02",
            "f.yaml:14: simulation.target: must be a mapping with relative_error and of: "
            "write target: {relative_error: 0.02} [got 0.02]",
        ),
        (
            "rays: 1e7",
            "target: good",
            "f.yaml:14: simulation.target: must be a mapping with relative_error and of: "
            "write target: {relative_error: 1%} [got 'good']",
        ),
        ("rays: 1e7", "rays: 99", f"f.yaml:14: simulation.rays: {RAYS} [got 99]"),
        ("rays: 1e7", "rays: 1000.5", f"f.yaml:14: simulation.rays: {RAYS} [got 1000.5]"),
        ("rays: 1e7", "rays: many", f"f.yaml:14: simulation.rays: {RAYS} [got 'many']"),
        ("rays: 1e7", "rays: 1e16", f"f.yaml:14: simulation.rays: {RAYS} [got 1e+16]"),
        ("seed: 1", "seed: -1", f"f.yaml:14: simulation.seed: {SEED} [got -1]"),
        (
            "seed: 1",
            "seed: 9223372036854775808",
            f"f.yaml:14: simulation.seed: {SEED} [got 9223372036854775808]",
        ),
        (
            "seed: 1",
            "seed: 1e18",
            "f.yaml:14: simulation.seed: must be written with all its digits: "
            "a number this large is not exact with an exponent [got 1e+18]",
        ),
        (
            "seed: 1",
            "threads: 0",
            "f.yaml:14: simulation.threads: must be a whole number from 1 to 4096; "
            "leave it out to use every core [got 0]",
        ),
        (
            "seed: 1",
            "orders: 17",
            "f.yaml:14: simulation.orders: must be a whole number from 1 to 16; "
            "leave it out for no decomposition [got 17]",
        ),
        (
            "seed: 1",
            "orders: null",
            "f.yaml:14: simulation.orders: must be a whole number from 1 to 16; "
            "leave it out for no decomposition [got nothing]",
        ),
        (
            "classic}",
            "classic, rows: 0}",
            "f.yaml:13: slice.rows: must be a whole number from 1 to 4e6 [got 0]",
        ),
        (
            "classic}",
            "classic, rows: 2001, columns: 2000}",
            "f.yaml:13: slice: must have no more than 4e6 cells, and rows x columns is 4002000: use fewer of either",
        ),
        # names and choices
        ("patina", "../patina", f"f.yaml:2: material.name: {NAME} [got '../patina']"),
        ("patina", ".patina", f"f.yaml:2: material.name: {NAME} [got '.patina']"),
        ("patina", "my patina", f"f.yaml:2: material.name: {NAME} [got 'my patina']"),
        ("patina", "'patina\\n'", f"f.yaml:2: material.name: {NAME} [got 'patina\\\\n']"),
        ("patina", "'patina\n\n'", f"f.yaml:2: material.name: {NAME} [got 'patina\\n']"),
        ("patina", "''", f"f.yaml:2: material.name: {NAME} [got '']"),
        ("patina", "pátina", f"f.yaml:2: material.name: {NAME} [got 'pátina']"),
        ("patina", "p" * 121, f"f.yaml:2: material.name: {NAME} [got '{'p' * 56}...]"),
        (
            "patina",
            "12",
            f"f.yaml:2: material.name: {NAME}; write it between quotes if it looks like a number [got 12]",
        ),
        (
            "dielectric",
            "dielectrc",
            f"{COAT}.type: must be dielectric, conductor or lambert [got 'dielectrc'] (did you mean dielectric?)",
        ),
        ("dielectric", "wood", f"{COAT}.type: must be dielectric, conductor or lambert [got 'wood']"),
        ("dielectric", "[1]", f"{COAT}.type: must be dielectric, conductor or lambert [got [1]]"),
        (
            "classic}",
            "Halb}",
            "f.yaml:13: slice.parametrization: must be classic or half [got 'Halb'] (did you mean half?)",
        ),
        (
            "seed: 1",
            "estimator: analogue",
            "f.yaml:14: simulation.estimator: must be auto, analog, split, operator or connection [got 'analogue'] "
            "(did you mean analog?)",
        ),
        # keys
        (
            "eta: 1.5,",
            "eta: 1.5, alhpa: 1,",
            f"{COAT}.alhpa: unknown key; the keys here are type, eta and alpha (did you mean alpha?)",
        ),
        (
            "eta: 1.5,",
            "eta: 1.5, rho: 1,",
            f"{COAT}.rho: unknown key; the keys here are type, eta and alpha",
        ),
        (
            "eta: 1.5,",
            "eta: 1.5, dielectric: 1,",
            f"{COAT}.dielectric: unknown key; the keys here are type, eta and alpha",
        ),
        (
            "slice:",
            "Slices:",
            "f.yaml:13: Slices: unknown key; the keys here are material, incident, slice and simulation "
            "(did you mean slice?)",
        ),
        (
            "  name:",
            "  interface: {}\n  name:",
            "f.yaml:2: material.interface: unknown key; the keys here are name and layers",
        ),
        ("eta: 1.5, ", "", f"{COAT}.eta: {MISSING}"),
        ("type: dielectric, ", "", f"{COAT}.type: is missing: give one of dielectric, conductor or lambert"),
        (
            "        kappa: [1.0, 0.01, 0.01]\n",
            "",
            f"f.yaml:6: material.layers[2].interface.kappa: {MISSING}",
        ),
        ("{tau: [0.05, 0.1, 0.8]}", "{}", f"f.yaml:5: material.layers[1].medium.tau: {MISSING}"),
        ("  name: patina\n", "", f"f.yaml:1: material.name: {MISSING}"),
        ("incident:\n  theta_deg: [0, 15, 30]\n", "", f"f.yaml:1: incident: {MISSING}"),
        (
            "name: patina",
            "name: patina\n  name: again",
            "f.yaml:3: material.name: this key is there twice (the other is on line 2): remove one",
        ),
        ("name: patina", "? [a]\n  : b", "f.yaml:2: material.?: a key must be a single word"),
        # mappings and lists
        (
            "slice: {parametrization: classic}",
            "slice:",
            "f.yaml:13: slice: must be a mapping with parametrization, rows and columns [got nothing]",
        ),
        (
            "simulation: {rays: 1e7, seed: 1}",
            "simulation: 1e7",
            "f.yaml:14: simulation: must be a mapping with rays, target, max_rays, max_time, seed, estimator, "
            "orders and threads [got 10000000.0]",
        ),
        (
            "{type: dielectric, eta: 1.5, alpha: 0.2}",
            "dielectric",
            "f.yaml:4: material.layers[0].interface: must be a mapping with type [got 'dielectric']",
        ),
        (
            "- medium: {tau: [0.05, 0.1, 0.8]}",
            "- coat",
            "f.yaml:5: material.layers[1]: must be a mapping with interface or medium [got 'coat']",
        ),
        (
            "interface: {type: dielectric, eta: 1.5, alpha: 0.2}",
            "{type: dielectric, eta: 1.5}",
            "f.yaml:4: material.layers[0]: must say that it is an interface: write `interface: {type: ...}`",
        ),
        (
            "medium: {tau: [0.05, 0.1, 0.8]}",
            "tau: 1",
            "f.yaml:5: material.layers[1]: must say that it is a medium: write `medium: {tau: ...}`",
        ),
        (
            "    - medium: {",
            "      medium: {",
            "f.yaml:4: material.layers[0]: must hold either an interface or a medium: "
            "give each its own `- ` in the list",
        ),
    ],
)
def test_one_mistake_one_line(old, new, line):
    assert old in SCENE
    with pytest.raises(ConfigError) as caught:
        parse_scene(SCENE.replace(old, new, 1), "f.yaml")
    assert caught.value.problems == [line]
