"""The typed scene: what it offers, writing it as YAML, its fingerprint."""

import random
import subprocess
import sys

import pydantic
import pytest

from goniosim.scene import Scene, parse_scene

PATINA = {
    "material": {
        "name": "patina",
        "layers": [
            {"interface": {"type": "dielectric", "eta": 1.5, "alpha": 0.2}},
            {"medium": {"tau": [0.05, 0.1, 0.8]}},
            {"interface": {"type": "conductor", "eta": 1.45, "kappa": [1.0, 0.01, 0.01], "alpha": 0.2}},
        ],
    },
    "incident": {"theta_deg": [0, 15, 30]},
}


def patina(**changes):
    return parse_scene({**PATINA, **changes})


def layered(*layers):
    return parse_scene({**PATINA, "material": {"name": "stack", "layers": list(layers)}})


def dielectric(eta=1.5, alpha=0.0):
    return {"interface": {"type": "dielectric", "eta": eta, "alpha": alpha}}


def medium(tau):
    return {"medium": {"tau": tau}}


WHITE = {"interface": {"type": "lambert", "rho": 1}}


def test_defaults_are_those_of_the_format():
    scene = patina()
    assert scene.slice.model_dump() == {"parametrization": "classic", "rows": 90, "columns": 360}
    assert scene.simulation.model_dump() == {
        "rays": 10_000_000,
        "seed": 1,
        "estimator": "analog",
        "orders": None,
        "threads": None,
    }
    assert layered({"interface": {"type": "dielectric", "eta": 1.5}}).material.interfaces[0].alpha == 0.0


def test_interfaces_come_top_to_bottom_with_rgb():
    top, base = patina().material.interfaces
    assert (top.type, top.eta, top.alpha) == ("dielectric", 1.5, 0.2)
    assert base.eta_rgb == (1.45, 1.45, 1.45)
    assert base.kappa_rgb == (1.0, 0.01, 0.01)
    assert layered(WHITE).material.interfaces[0].rho_rgb == (1.0, 1.0, 1.0)


def test_tau_adds_up_media_in_a_row_and_is_zero_where_interfaces_touch():
    scene = layered(dielectric(), medium(0.5), medium([0.25, 0, 1]), dielectric(1.2), dielectric(), WHITE)
    assert scene.material.tau == ((0.75, 0.5, 1.5), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert layered(WHITE).material.tau == ()


@pytest.mark.parametrize(
    "last, transmits",
    [
        (dielectric(1.0), True),
        (WHITE, False),
        ({"interface": {"type": "conductor", "eta": 1, "kappa": 1}}, False),
    ],
)
def test_transmits_through_a_dielectric_only(last, transmits):
    assert layered(dielectric(), last).material.transmits is transmits


def test_whole_numbers_may_be_written_with_an_exponent_and_become_int():
    scene = patina(simulation={"rays": 1e7, "seed": 2**63 - 1, "threads": 2.0, "orders": 3})
    assert [type(number) for number in (scene.simulation.rays, scene.simulation.threads)] == [int, int]
    assert scene.simulation.rays == 10_000_000
    assert scene.simulation.seed == 2**63 - 1


def test_numpy_scalars_are_numbers_too():
    numpy = pytest.importorskip("numpy")
    scene = patina(simulation={"rays": numpy.int64(1000)}, incident={"theta_deg": [numpy.float32(30)]})
    assert (type(scene.simulation.rays), type(scene.incident.theta_deg[0])) == (int, float)


@pytest.mark.parametrize(
    "place, key, value",
    [
        ("incident", "theta_deg", [0.0, 89.999999]),
        ("simulation", "rays", 100),
        ("simulation", "rays", 10**15),
        ("simulation", "seed", 0),
        ("simulation", "orders", 16),
        ("slice", "rows", 1),
        ("slice", "columns", 40_000),
    ],
)
def test_the_ends_of_the_ranges_are_allowed(place, key, value):
    scene = patina(**{place: {key: value}})
    found = getattr(getattr(scene, place), key)
    assert list(found) == value if isinstance(value, list) else found == value


def test_the_ends_of_the_ranges_of_layers_are_allowed():
    scene = layered(
        dielectric(0.1, 1e-6),
        medium(1e9),
        dielectric(10, 1),
        medium(0),
        {"interface": {"type": "conductor", "eta": 0.001, "kappa": 0, "alpha": 0}},
    )
    assert [face.alpha for face in scene.material.interfaces] == [1e-6, 1.0, 0.0]


def test_a_scene_cannot_be_changed():
    with pytest.raises(pydantic.ValidationError, match="frozen"):
        patina().simulation.rays = 5


def test_models_made_directly_are_checked_too():
    with pytest.raises(pydantic.ValidationError, match="must be the last layer"):
        Scene.model_validate(
            {
                "material": {"name": "upside-down", "layers": [WHITE, dielectric()]},
                "incident": {"theta_deg": [0]},
            }
        )


def random_scene(rng):
    """Any scene that the format allows, with awkward numbers in it."""

    def number(low, high):
        return rng.choice([low, high, rng.uniform(low, high), round(rng.uniform(low, high), 3)])

    def channels(low, high):
        return number(low, high) if rng.random() < 0.5 else [number(low, high) for _ in range(3)]

    def alpha():
        return rng.choice([0, 1e-6, 1, 10 ** rng.uniform(-6, 0)])

    layers = []
    for _ in range(rng.randint(0, 4)):
        layers.append(dielectric(number(0.1, 10), alpha()))
        layers += [medium(channels(0, rng.choice([5e-324, 1, 1e9]))) for _ in range(rng.choice([0, 1, 1, 2]))]
    conductor = {"type": "conductor", "eta": channels(0.001, 9), "kappa": channels(0, 9), "alpha": alpha()}
    lambert = {"type": "lambert", "rho": channels(0, 1)}
    layers.append(rng.choice([dielectric(1, alpha()), {"interface": conductor}, {"interface": lambert}]))
    simulation = {"rays": rng.choice([100, 1e7, 10**15]), "seed": rng.randrange(2**63)}
    if rng.random() < 0.5:
        simulation |= {"orders": rng.randint(1, 16), "threads": rng.randint(1, 64)}
    return parse_scene(
        {
            "material": {
                "name": rng.choice(["a", "1e7", "null", "-x=1.5+2", "0x10", "yes"]),
                "layers": layers,
            },
            "incident": {"theta_deg": sorted({0, 90 - 1e-9, number(0, 89)})},
            "slice": {"parametrization": rng.choice(["classic", "half"]), "rows": rng.randint(1, 100)},
            "simulation": simulation,
        }
    )


def test_yaml_round_trip_of_random_scenes():
    rng = random.Random(20190715)
    for _ in range(80):
        scene = random_scene(rng)
        again = parse_scene(scene.to_yaml())
        assert again == scene
        assert again.config_hash() == scene.config_hash()
        assert again.to_yaml() == scene.to_yaml()


def test_yaml_is_complete_and_readable():
    text = patina().to_yaml()
    for line in (
        "  name: patina",
        "  - interface: {type: dielectric, eta: 1.5, alpha: 0.2}",
        "slice: {parametrization: classic, rows: 90, columns: 360}",
        "simulation: {rays: 10000000, seed: 1, estimator: analog}",
    ):
        assert line in text.splitlines()


def test_hash_ignores_what_does_not_determine_the_numbers():
    for same in ({"threads": 3}, {"rays": 1e6}):
        assert patina(simulation=same).config_hash() == patina().config_hash()
    one = layered(dielectric(), medium(0.75), WHITE)
    for same in (
        layered(dielectric(), medium([0.75, 0.75, 0.75]), WHITE),
        layered(dielectric(), medium(0.25), medium(0.5), WHITE),
        layered(dielectric(1.5, -0.0), medium(0.75), {"interface": {"type": "lambert", "rho": [1, 1, 1]}}),
    ):
        assert same.config_hash() == one.config_hash()
    renamed = {**PATINA["material"], "name": "other"}
    assert patina(material=renamed).config_hash() == patina().config_hash()


def test_hash_tells_apart_what_determines_the_numbers():
    scenes = [
        patina(),
        patina(simulation={"seed": 2}),
        patina(simulation={"orders": 2}),
        patina(slice={"parametrization": "half"}),
        patina(slice={"rows": 91}),
        patina(slice={"columns": 361}),
        patina(incident={"theta_deg": [0, 30, 15]}),
        layered(dielectric(), WHITE),
        layered(dielectric(1.6), WHITE),
        layered(dielectric(1.5, 0.1), WHITE),
        layered(dielectric(), medium(0.1), WHITE),
        layered(dielectric(), medium([0.1, 0.1, 0.2]), WHITE),
        layered(dielectric(), {"interface": {"type": "lambert", "rho": 0.5}}),
        layered(dielectric(), dielectric(), WHITE),
        layered(dielectric(), {"interface": {"type": "conductor", "eta": 1, "kappa": 1}}),
        layered(dielectric(), {"interface": {"type": "conductor", "eta": 1, "kappa": 0}}),
    ]
    assert len({scene.config_hash() for scene in scenes}) == len(scenes)


def test_hash_stays_what_it_was():
    # Result files carry this fingerprint; if it changes, old files no longer match their scene.
    assert patina().config_hash() == "6e439dd716df053cbcd491f09a54faa5c484b54a29068be482e77ff693cb632a"


def test_reading_scenes_needs_nothing_heavy():
    code = (
        "import sys, goniosim.scene; "
        "print([name for name in ('numpy', 'numba', 'h5py', 'matplotlib') if name in sys.modules])"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "[]"
