"""Finding 7: elek10 does not tell a frosted metal from a patina."""

import numpy as np

from ..markdown import number, table
from ..materials import METALS, one, select
from ..slices import model_energy
from ..study import Finding
from ..verdicts import NO, YES, Claim

TITLE = "elek10 is identical on frosted metal and patina"
PAPER = (
    "Elek's model gives the same BRDF for a frosted metal (α₀ = 0.2, α₁ = 0.001) and for a patina (α₀ = α₁ = 0.2), by "
    "construction: it raises α₁ to max(α₀, α₁) (Section 4.2, Fig. 8)."
)
COAT, FROSTED, PATINA = 0.2, 0.001, 0.2


def measure(study):
    """The `Finding`."""
    answers, rows = {}, []
    for label in dict.fromkeys(m.label for m in select(study.materials, category=METALS)):
        pair = [one(study.materials, label, COAT, alpha1) for alpha1 in (FROSTED, PATINA)]
        difference = {name: _largest_difference(study, pair, name) for name in ("elek10", "ww09")}
        answers[label] = YES if difference["elek10"] == 0.0 else NO
        errors = [number(study.errors.rmse(m, "elek10")) for m in pair]
        rows.append([label, f"{difference['elek10']:g}", f"{difference['ww09']:.0f}", *errors])
    head = [
        "metal",
        "elek10: difference",
        "ww09: difference",
        "elek10: RMSE [sr^-1/2], frosted",
        "elek10: RMSE [sr^-1/2], patina",
    ]
    return Finding(
        [Claim("internal paths identical in every cell", answers)],
        [
            "Largest difference between the integrated energies of the cells of the two materials, over all cells, "
            "channels and directions, in units of the largest energy of the patina; internal paths, stored with 24 "
            "significant bits. ww09, whose lobe on the frosted metal is a spike, for contrast. "
            "The errors differ because the simulated materials do.",
            table(head, rows),
        ],
    )


def _largest_difference(study, pair, model):
    first, second = (model_energy(study.results, m.name, model, m.component) for m in pair)
    return float(np.max(np.abs(first - second)) / np.max(second))
