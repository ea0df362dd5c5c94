"""Metals of eta1 = 1.45 with other optical depths, which the paper does not print: for findings 4 to 6."""

import goniosim

from .scenes import conductor, simulate, tau_text
from .table import rmse_rows

NAME = "metal_tau"
ETA1 = 1.45
TAUS = {"τ = 0": 0.0, "τ = 0.5": 0.5, "τ = 1.5": 1.5, "τ = (0, 0, 2)": [0.0, 0.0, 2.0]}
MODELS = ["ww09", "elek10", "bati19_ww", "belcour18_forward", "belcour18_symmetric"]
# Given, so that no second reading is compared beside it.
ONLY = {model: {"refraction_scale": "auto"} for model in MODELS[3:]}


def run(results):
    """Yield rows for every setting and pair of roughnesses."""
    for setting, tau in TAUS.items():
        label = "M2" if isinstance(tau, list) else "M4"
        for alpha0 in (0.001, 0.05, 0.2):
            for alpha1 in (0.001, 0.2):
                name = f"{label}-alpha0_{alpha0:g}-alpha1_{alpha1:g}-tau_{tau_text(tau)}-eta1_{ETA1}"
                result = simulate(name, alpha0, tau, conductor(ETA1, alpha1))
                yield from rmse_rows(goniosim.compare(result, MODELS, ONLY), setting)
