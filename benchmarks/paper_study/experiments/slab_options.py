"""Other readings of Belcour's slab on two of the four: for finding 9."""

from itertools import product

import numpy as np

import goniosim

from ..errors import label
from ..lobes import GREEN, interquartile_range
from ..slices import view_directions
from ..verdicts import Value
from .table import cell, rmse_rows

NAME = "slab_options"
# Grey tau, both base roughnesses.
LABELS = ("S2", "S4")
MODEL, SIMULATION = "belcour18_forward", "simulation"
LIGHT = 75
CHOICES = {
    "jacobian": ("published", "snell"),
    "refraction_scale": ("paper", "normal"),
    "fgd": ("fresnel", "exact"),
}


def run(results):
    """Yield rows for every combination of options, under the plain name of the model."""
    files = sorted(path for path in results.glob("*.h5") if path.name.split("-")[0] in LABELS)
    for path in files:
        result = goniosim.open_result(path)
        for values in product(*CHOICES.values()):
            options = dict(zip(CHOICES, values, strict=True))
            setting = ", ".join(f"{name}={value}" for name, value in options.items())
            comparison = goniosim.compare(result, [MODEL], {MODEL: options})
            yield from rmse_rows(comparison, setting, lambda row: row["model"])
            bsdf = comparison.materials[0].bsdf(label(comparison.rows()[0]), "transmission")
            yield _width(result, setting, MODEL, bsdf)
        yield _width(result, SIMULATION, SIMULATION, result.components["transmission"].bsdf)


def _width(result, setting, model, bsdf):
    """Row of the width of the lobe with the light at `LIGHT` degrees, green channel."""
    m = int(np.argmin(np.abs(result.theta_deg - LIGHT)))
    valid = result.cells.valid[m]
    x = view_directions(result.cells, result.theta_deg[m])[0][valid]
    energy = (bsdf[m, GREEN] * result.cells.projected_solid_angle[m])[valid]
    return cell(setting, result.name, model, "width", Value(float(interquartile_range(x, energy))))
