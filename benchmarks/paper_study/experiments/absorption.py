"""Plastics with rho and tau varied one at a time, both grey: for finding 3."""

import goniosim

from ..verdicts import Value
from .scenes import simulate
from .table import cell

NAME = "absorption"
ALPHA0 = 0.05
TAUS = (0.0, 0.1, 0.2, 0.4, 0.8)
# The channels of one simulation.
RHOS = {"R": 0.1, "G": 0.5, "B": 0.9}
MODELS = ["ww09", "elek10", "bati19_ww"]


def run(results):
    """Yield rows; the material of a row is its rho."""
    for tau in TAUS:
        base = {"type": "lambert", "rho": list(RHOS.values())}
        comparison = goniosim.compare(simulate("plastic", ALPHA0, tau, base), MODELS)
        for channel, rho in RHOS.items():
            for row in comparison.rows(channel=channel):
                norm = row["reference_norm"]
                for quantity, scale in (("rmse", 1.0), ("relative", norm)):
                    found = Value(row["rmse_converged"] / scale, row["rmse_stderr"] / scale)
                    yield cell(f"τ = {tau:g}", f"ρ = {rho:g}", row["model"], quantity, found)
