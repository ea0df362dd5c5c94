"""A scene as YAML, and its identity: what survives writing and reading, what the hash tells apart."""

import random

from goniosim.scene import parse_scene
from patina import PATINA, WHITE, dielectric, layered, medium, patina


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
    if rng.random() < 0.3:
        del simulation["rays"]
        error, time = rng.choice([0.7e-2, "0.7%", rng.random() or 0.5]), rng.choice([0.1, "1h30m", 1e9])
        simulation |= {"target": {"relative_error": error, "of": rng.choice(["slice", "albedo", "cells"])}}
        simulation |= rng.choice([{}, {"max_rays": 1e9, "max_time": time}, {"max_time": time}])
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
        "simulation: {rays: 10000000, seed: 1, estimator: auto}",
    ):
        assert line in text.splitlines()


def test_hash_ignores_what_does_not_determine_the_numbers():
    aimed = {"target": {"relative_error": 0.01, "of": "albedo"}, "max_rays": 1e6, "max_time": "10m"}
    for same in ({"threads": 3}, {"rays": 1e6}, aimed):
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
        patina(simulation={"estimator": "analog"}),
        patina(simulation={"estimator": "split"}),
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
    analog = patina(simulation={"estimator": "analog"})
    assert analog.config_hash() == "6e439dd716df053cbcd491f09a54faa5c484b54a29068be482e77ff693cb632a"
