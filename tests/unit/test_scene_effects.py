"""Which effects a scene calls for, and the sentence that says why."""

import pytest

from goniosim.scene import distinct_channels, effects, parse_scene

NAMES = [
    "rough_interfaces",
    "smooth_interfaces",
    "lambertian",
    "conductor",
    "absorption",
    "transmission",
    "internal_paths",
    "chromatic",
    "orders",
]


def scene(*layers, **simulation):
    return parse_scene(
        {
            "material": {"name": "stack", "layers": list(layers)},
            "incident": {"theta_deg": [0]},
            "simulation": simulation,
        }
    )


def coat(alpha=0.0, eta=1.5):
    return {"interface": {"type": "dielectric", "eta": eta, "alpha": alpha}}


def base(rho=0.5):
    return {"interface": {"type": "lambert", "rho": rho}}


def metal(eta=1.45, kappa=1.0, alpha=0.0):
    return {"interface": {"type": "conductor", "eta": eta, "kappa": kappa, "alpha": alpha}}


def medium(tau):
    return {"medium": {"tau": tau}}


def found(one):
    return {effect.name: effect for effect in effects(one)}


@pytest.mark.parametrize(
    "one, active",
    [
        (scene(coat()), {"smooth_interfaces", "transmission"}),
        (scene(coat(0.1)), {"rough_interfaces", "transmission"}),
        (scene(base()), {"lambertian"}),
        (scene(metal()), {"conductor", "smooth_interfaces"}),
        (scene(coat(), base()), {"smooth_interfaces", "lambertian", "internal_paths"}),
        (scene(coat(), medium(0), base()), {"smooth_interfaces", "lambertian", "internal_paths"}),
        (
            scene(coat(), medium(0.1), coat(0.1, eta=1.0)),
            {"smooth_interfaces", "rough_interfaces", "absorption", "transmission", "internal_paths"},
        ),
        (
            scene(coat(), medium([0, 0, 0.1]), metal(alpha=0.1), orders=2),
            {
                "smooth_interfaces",
                "rough_interfaces",
                "absorption",
                "conductor",
                "internal_paths",
                "chromatic",
                "orders",
            },
        ),
    ],
)
def test_only_what_a_layer_or_option_asks_for_is_active(one, active):
    listed = effects(one)
    assert [effect.name for effect in listed] == NAMES
    assert {effect.name for effect in listed if effect.active} == active


def test_why_names_the_layers_that_ask():
    why = {
        name: effect.why
        for name, effect in found(
            scene(coat(0.2), medium([0.05, 0.1, 0.8]), metal(kappa=[1, 0.01, 0.01], alpha=0.001), orders=3)
        ).items()
    }
    assert why == {
        "rough_interfaces": "asked for by layers[0] (dielectric, alpha 0.2), layers[2] (conductor, alpha 0.001)",
        "smooth_interfaces": "no interface has alpha 0",
        "lambertian": "no interface is lambert",
        "conductor": "asked for by layers[2] (conductor, alpha 0.001)",
        "absorption": "asked for by layers[1] (medium, tau [0.05, 0.1, 0.8])",
        "transmission": "layers[2] (conductor, alpha 0.001) is the last interface and opaque",
        "internal_paths": "light walks between 2 interfaces",
        "chromatic": "no two channels agree everywhere: 3 distinct channels are traced",
        "orders": "simulation.orders asks for 3",
    }


def test_why_says_what_is_absent():
    why = {name: effect.why for name, effect in found(scene(coat())).items()}
    assert why["absorption"] == "no medium absorbs"
    assert why["internal_paths"] == "layers[0] (dielectric, alpha 0) is the only interface"
    assert why["orders"] == "simulation.orders is not given"
    assert why["transmission"] == "layers[0] (dielectric, alpha 0) is the last interface and lets light out below"


@pytest.mark.parametrize(
    "layers, representatives, positions, why",
    [
        ([coat(), base(0.5)], [0], [0, 0, 0], "all channels agree everywhere: 1 distinct channel is traced"),
        ([coat(), base([0.5, 0.5, 0.5])], [0], [0, 0, 0], "all channels agree"),
        (
            [coat(), metal(kappa=[1, 0.01, 0.01])],
            [0, 1],
            [0, 1, 1],
            "green and blue agree everywhere: 2 distinct channels are traced",
        ),
        ([coat(), base([0.1, 0.6, 0.1])], [0, 1], [0, 1, 0], "red and blue agree everywhere: 2 distinct"),
        (
            [coat(), medium([0, 0, 1]), base()],
            [0, 2],
            [0, 0, 1],
            "red and green agree everywhere: 2 distinct",
        ),
        ([coat(), metal(eta=[1, 2, 3])], [0, 1, 2], [0, 1, 2], "no two channels agree"),
        (
            [coat(), medium([0, 0, 1]), metal(kappa=[1, 0.01, 0.01])],
            [0, 1, 2],
            [0, 1, 2],
            "no two channels agree everywhere: 3 distinct",
        ),
        # Media in a row are traced as their sum, so only the sum has to agree.
        ([coat(), medium([1, 0, 0]), medium([0, 1, 1]), base()], [0], [0, 0, 0], "all channels agree"),
    ],
)
def test_channels_that_agree_everywhere_are_traced_once(layers, representatives, positions, why):
    one = scene(*layers)
    assert distinct_channels(one) == (representatives, positions)
    effect = found(one)["chromatic"]
    assert effect.active is (len(representatives) > 1)
    assert effect.why.startswith(why)
