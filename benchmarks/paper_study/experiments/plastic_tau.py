"""The plastics of one coat with other numbers for what the paper does not print: for findings 1 to 3."""

import goniosim

from .scenes import simulate, tau_text
from .table import rmse_rows

NAME = "plastic_tau"
MODELS = ["ww09", "elek10", "bati19_ww"]
# The coat hardly matters for the errors of plastics.
ALPHA0 = 0.05
# tau C, tau A, rho C, rho A.
SETTINGS = {
    "τ C weaker: (0, 0, 0.4)": ([0.0, 0.0, 0.4], 0.2, [0.1, 0.6, 0.1], 0.5),
    "τ C stronger: (0.2, 0.4, 3.2)": ([0.2, 0.4, 3.2], 0.2, [0.1, 0.6, 0.1], 0.5),
    "τ A = 0.05": ([0.05, 0.1, 0.8], 0.05, [0.1, 0.6, 0.1], 0.5),
    "τ A = 0.8": ([0.05, 0.1, 0.8], 0.8, [0.1, 0.6, 0.1], 0.5),
    "ρ C = (0.3, 0.9, 0.3)": ([0.05, 0.1, 0.8], 0.2, [0.3, 0.9, 0.3], 0.5),
    "ρ A = 0.2": ([0.05, 0.1, 0.8], 0.2, [0.1, 0.6, 0.1], 0.2),
    "ρ A = 0.9": ([0.05, 0.1, 0.8], 0.2, [0.1, 0.6, 0.1], 0.9),
}


def run(results):
    """Yield rows for every setting and plastic."""
    for setting, (tau_c, tau_a, rho_c, rho_a) in SETTINGS.items():
        bodies = {"P1": (tau_c, rho_c), "P2": (tau_c, rho_a), "P3": (tau_a, rho_c), "P4": (tau_a, rho_a)}
        for label, (tau, rho) in bodies.items():
            name = f"{label}-alpha0_{ALPHA0:g}-tau_{tau_text(tau)}-rho_{tau_text(rho)}"
            result = simulate(name, ALPHA0, tau, {"type": "lambert", "rho": rho})
            yield from rmse_rows(goniosim.compare(result, MODELS), setting)
