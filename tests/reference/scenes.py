"""Scenes for tests, in one line each."""


def dielectric(eta, alpha=0.0):
    return {"interface": {"type": "dielectric", "eta": eta, "alpha": alpha}}


def conductor(eta, kappa, alpha=0.0):
    return {"interface": {"type": "conductor", "eta": eta, "kappa": kappa, "alpha": alpha}}


def lambert(rho):
    return {"interface": {"type": "lambert", "rho": rho}}


def medium(tau):
    return {"medium": {"tau": tau}}


def make_scene(layers, theta_deg, parametrization="classic", rows=90, columns=360, **simulation):
    """A goniosim scene of the given layers.

    Parameters
    ----------
    layers : list of dict
        As made by the functions above, top to bottom.
    theta_deg : float or list of float
    parametrization : str
    rows, columns : int
    **simulation
        Entries of the scene's ``simulation`` section, such as ``rays`` and ``seed``.
    """
    from goniosim.scene import parse_scene

    thetas = theta_deg if isinstance(theta_deg, list) else [theta_deg]
    return parse_scene(
        {
            "material": {"name": "test", "layers": layers},
            "incident": {"theta_deg": thetas},
            "slice": {"parametrization": parametrization, "rows": rows, "columns": columns},
            "simulation": {"rays": 100_000, "seed": 1, **simulation},
        }
    )


# A stack for each estimator: operator; two of them, one for each way out; split; connection.
METAL = [dielectric(1.5, 0.3), medium([0.05, 0.1, 0.8]), conductor(1.45, [1.0, 0.5, 0.5], 0.3)]
SLAB = [dielectric(1.5, 0.001), medium(0.2), dielectric(1.0, 0.3)]
NARROW = [dielectric(1.5, 0.01), conductor(1.45, 1.0, 0.01)]
PLASTIC = [dielectric(1.5, 0.1), lambert(0.5)]
