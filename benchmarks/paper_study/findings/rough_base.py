"""Finding 4: the order of the models on metals with a rough base."""

from ..materials import METALS, select
from ..study import Finding
from ..verdicts import ALIKE, Claim
from .answers import agree, ordered

TITLE = "Metals, α₁ = 0.2: Belcour's two models best and alike, then elek10, then ww09"
PAPER = (
    "Among the models as published, Belcour's give the best results, the forward and the symmetric variant being "
    "similar; Elek's follows, then Weidlich and Wilkie's (caption of Fig. 4b, Section 4.2)."
)
MODELS = ("ww09", "elek10", "belcour18_forward", "belcour18_symmetric")
ROUGH = 0.2


def claims(table, materials):
    """Claims on a table of errors: dict of (material name, model) to `Value`."""
    metals = select(materials, category=METALS, alpha1=ROUGH)
    forward, symmetric = MODELS[2:]
    return [
        *(Claim(f"{model} < elek10", ordered(table, metals, model, "elek10")) for model in (forward, symmetric)),
        Claim("elek10 < ww09", ordered(table, metals, "elek10", "ww09")),
        Claim("forward and symmetric alike", agree(table, metals, forward, symmetric, ALIKE)),
    ]


def measure(study):
    """The `Finding`."""
    metals = select(study.materials, category=METALS, alpha1=ROUGH)
    return Finding(claims(study.errors.table(), study.materials), [study.rmse_table(metals, MODELS)])
