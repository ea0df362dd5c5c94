"""Finding 10: Eq. 6 changes the first lobe of Belcour's forward model and nothing else."""

import numpy as np

from ..markdown import number, table
from ..materials import METALS, select
from ..slices import model_energy
from ..study import Finding, name_of
from ..verdicts import NO, YES, Claim, less

TITLE = "Eq. 6 equals forward on internal paths and corrects the first lobe"
PAPER = (
    "Replacing lobe 0 of the forward model by the exact reflection off the top interface leaves the errors of internal "
    "paths as they are, and corrects the direct reflection properly (Section 5.2, Figs. 10 and 11)."
)
FORWARD, EQ6 = "belcour18_forward", "bati19_belcour"
DIRECT, ALL = "reflection/direct", "reflection"
# Share of its norm to which the first lobe is right: the accuracy of 5 x 5 sub-cells.
EXACT = 0.02
# The materials whose slices are looked at: one metal with every pair of roughnesses.
SHOWN = "M4"


def measure(study):
    """The `Finding`."""
    metals = select(study.materials, category=METALS)
    same = {name_of(m): _same(study.errors, m) for m in metals}
    total = {name_of(m): less(study.errors.rmse(m, EQ6, ALL), study.errors.rmse(m, FORWARD, ALL)) for m in metals}
    cells, lobe, rows = {}, {}, []
    for m in select(metals, label=SHOWN):
        inner = [model_energy(study.results, m.name, model, m.component) for model in (FORWARD, EQ6)]
        difference = float(np.max(np.abs(inner[0] - inner[1])))
        cells[name_of(m)] = YES if difference == 0.0 else NO
        direct = {model: _direct_error(study, m, model) for model in (FORWARD, EQ6)}
        lobe[name_of(m)] = YES if direct[EQ6] <= EXACT else NO
        errors = [number(study.errors.rmse(m, model, ALL)) for model in (FORWARD, EQ6)]
        rows.append([name_of(m), f"{difference:g}", f"{direct[FORWARD]:.2g}", f"{direct[EQ6]:.2g}", *errors])
    head = [
        "material",
        "internal: difference",
        "direct: forward",
        "direct: Eq. 6",
        "RMSE of all [sr^-1/2]: forward",
        "RMSE of all [sr^-1/2]: Eq. 6",
    ]
    return Finding(
        [
            Claim("internal paths: RMSE identical to the last digit", same),
            Claim(f"internal paths: energy of every cell identical ({SHOWN})", cells),
            Claim(f"direct reflection right to {EXACT:.0%} of its norm ({SHOWN})", lobe),
            Claim("all reflection: RMSE of Eq. 6 < forward", total),
        ],
        [
            "Largest difference of the energies of internal paths in a cell; root mean square error of the direct "
            "reflection over its own norm (5 x 5 sub-cells); RMSE of all reflection.",
            table(head, rows),
        ],
    )


def _same(errors, material):
    rows = [errors.row(material, model) for model in (FORWARD, EQ6)]
    return YES if rows[0]["rmse"] == rows[1]["rmse"] else NO


def _direct_error(study, material, model):
    """Error of the direct reflection relative to its norm, all directions and channels together."""
    slices = study.slices(material)
    cells = slices.result.cells
    size = np.where(cells.valid, cells.projected_solid_angle, np.inf)[:, None]
    truth = slices.reference(DIRECT).energy
    difference = model_energy(study.results, material.name, model, DIRECT) - truth
    return float(np.sqrt((difference**2 / size).sum() / (truth**2 / size).sum()))
