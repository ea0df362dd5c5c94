"""Finding 6: where Eq. 5 is the best of the Weidlich-Wilkie family on metals."""

from ..markdown import number, table
from ..materials import METALS, select
from ..slices import ratio
from ..study import Finding
from ..verdicts import Claim
from .answers import ordered

TITLE = "Eq. 5 the best of its family on metallic paints and patinas, on frosted metals only at α₀ = 0.001"
PAPER = (
    "With a rough base (α₁ = 0.2: paints and patinas) the variant of Eq. 5 has smaller errors than the two others of "
    "its family. With a smooth base (α₁ = 0.001: frosted metals) its errors are smaller than Elek's only when α₀ = "
    "0.001 (Section 5.1, Fig. 4b)."
)
FAMILY = ("ww09", "elek10")


def claims(table, materials):
    """Claims on a table of errors: dict of (material name, model) to `Value`."""
    rough = select(materials, category=METALS, alpha1=0.2)
    smooth = select(materials, category=METALS, alpha1=0.001)
    clear = [m for m in smooth if m.alpha0 == 0.001]
    frosted = [m for m in smooth if m.alpha0 > 0.001]
    return [
        Claim("α₁ = 0.2: bati19_ww < ww09", ordered(table, rough, "bati19_ww", "ww09")),
        Claim("α₁ = 0.2: bati19_ww < elek10", ordered(table, rough, "bati19_ww", "elek10")),
        Claim("α₁ = 0.001, α₀ = 0.001: bati19_ww < elek10", ordered(table, clear, "bati19_ww", "elek10")),
        Claim("α₁ = 0.001, α₀ = 0.05 and 0.2: bati19_ww > elek10", ordered(table, frosted, "elek10", "bati19_ww")),
    ]


def measure(study):
    """The `Finding`."""
    metals = select(study.materials, category=METALS)
    labels = list(dict.fromkeys(m.label for m in metals))
    alphas = sorted({(m.alpha1, m.alpha0) for m in metals})
    rows = []
    for alpha1, alpha0 in alphas:
        for other in FAMILY:
            found = [
                ratio(study.errors.rmse(m, "bati19_ww"), study.errors.rmse(m, other))
                for m in select(metals, alpha0=alpha0, alpha1=alpha1)
            ]
            rows.append([f"{other}, α₀ = {alpha0:g}, α₁ = {alpha1:g}", *map(number, found)])
    body = [
        "RMSE of Eq. 5 over that of the other model; below 1 Eq. 5 is the better one.",
        table(["other", *labels], rows),
    ]
    return Finding(claims(study.errors.table(), study.materials), body)
