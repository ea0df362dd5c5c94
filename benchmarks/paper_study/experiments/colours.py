"""Where the colours at grazing angles come from: orders of the simulation, readings of the models; for finding 11."""

from itertools import product

import numpy as np

import goniosim

from ..errors import label
from ..slices import energy_in, ratio, slice_of, view_directions
from ..verdicts import Value
from .scenes import conductor, simulate
from .table import cell

NAME = "colours"
ORDERS, ROUGH, TAU = 4, 0.2, 0.2
INDICES = (1.2, 1.9)
LIGHT, VIEWER = 75, 75.0
MODELS, FGD = ("belcour18_forward", "belcour18_symmetric"), ("exact", "fresnel")


def run(results):
    """Yield rows: green over red, and the share of green, beyond `VIEWER` with the light at `LIGHT` degrees."""
    for eta1 in INDICES:
        result = simulate(f"patina-{eta1}", ROUGH, TAU, conductor(eta1, ROUGH), ORDERS)
        m = int(np.argmin(np.abs(result.theta_deg - LIGHT)))
        tilt = np.degrees(np.arccos(np.clip(view_directions(result.cells, result.theta_deg[m])[2], -1.0, 1.0)))
        where = (tilt > VIEWER) & result.cells.valid[m]
        internal = result.components["reflection/internal"]
        all_green = energy_in(slice_of(result, internal), m, where)[1]
        for name, part in {"all orders": internal, **internal.orders}.items():
            red, green, _ = energy_in(slice_of(result, part), m, where)
            for quantity, found in (("G/R", ratio(green, red)), ("share of green", ratio(green, all_green))):
                yield cell(f"η₁ = {eta1}", name.replace("_", " "), "simulation", quantity, found)
        for model, fgd in product(MODELS, FGD):
            comparison = goniosim.compare(result, [model], {model: {"fgd": fgd, "refraction_scale": "normal"}})
            bsdf = comparison.materials[0].bsdf(label(comparison.rows()[0]), "reflection/internal")
            energy = (bsdf[m] * result.cells.projected_solid_angle[m])[:, where].sum(axis=1)
            yield cell(f"η₁ = {eta1}", f"fgd={fgd}", model, "G/R", Value(float(energy[1] / energy[0])))
