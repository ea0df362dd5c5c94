"""A metallic patina, and scenes near it."""

from goniosim.scene import parse_scene

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
