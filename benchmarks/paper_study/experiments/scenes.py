"""Small simulations beside the 60: the same stacks with other numbers in them."""

import goniosim
from goniosim.scene import parse_scene

THETAS = [0, 15, 30, 45, 60, 75, 85]
COAT = {"type": "dielectric", "eta": 1.5}
KAPPA = [1.0, 0.01, 0.01]
# Light paths per incident direction.
RAYS = 1e6


def simulate(name, alpha0, tau, base, orders=None):
    """Simulate a coat over a base as the configurations of the paper do.

    Parameters
    ----------
    name : str
    alpha0 : float
    tau : float or list of float
    base : dict
        The last interface.
    orders : int, optional
        Orders to tell apart.

    Returns
    -------
    goniosim.result.Result
    """
    simulation = {"rays": int(RAYS), "seed": 2}
    if orders is not None:
        simulation["orders"] = orders
    content = {
        "material": {
            "name": name,
            "layers": [{"interface": COAT | {"alpha": alpha0}}, {"medium": {"tau": tau}}, {"interface": base}],
        },
        "incident": {"theta_deg": THETAS},
        "slice": {"parametrization": "classic" if alpha0 == 0.2 else "half"},
        "simulation": simulation,
    }
    return goniosim.simulate(parse_scene(content))


def conductor(eta1, alpha1):
    """The conducting base of the paper."""
    return {"type": "conductor", "eta": eta1, "kappa": KAPPA, "alpha": alpha1}


def tau_text(tau):
    """Tau as it is written in names of materials."""
    return "_".join(f"{value:g}" for value in tau) if isinstance(tau, list) else f"{tau:g}"
