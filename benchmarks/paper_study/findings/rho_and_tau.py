"""Finding 3: how the errors on plastics depend on the albedo of the base and on absorption."""

from itertools import pairwise, product

from ..experiments.table import settings_of
from ..markdown import number, table
from ..materials import PLASTICS, mean_of, one, select
from ..study import Finding
from ..verdicts import Claim, less

TITLE = "On plastics errors grow with ρ and τ"
PAPER = (
    "The errors of both models, Weidlich and Wilkie's and Elek's, increase when ρ or τ increases, which "
    "inter-reflections are to explain (Section 4.2, Fig. 4a)."
)
MODELS = ("ww09", "elek10")
# Pairs of labels that differ in nothing but rho, and in nothing but tau.
RHO, TAU = (("P1", "P2"), ("P3", "P4")), (("P1", "P3"), ("P2", "P4"))


def claims(table, materials):
    """Claims on a table of errors: dict of (material name, model) to `Value`."""
    coats = sorted({m.alpha0 for m in select(materials, category=PLASTICS)})

    def grows(pairs, size):
        answers = {}
        for model, pair, alpha0 in product(MODELS, pairs, coats):
            low, high = sorted((one(materials, label, alpha0) for label in pair), key=size)
            if size(low) < size(high):
                what = f"{model}, {low.label} to {high.label}, α₀ = {alpha0:g}"
                answers[what] = less(table[low.name, model], table[high.name, model])
        return answers

    return [
        Claim("grows with the mean of ρ over the channels", grows(RHO, lambda m: mean_of(m.base))),
        Claim("grows with the mean of τ over the channels", grows(TAU, lambda m: mean_of(m.tau))),
    ]


def measure(study):
    """The `Finding`."""
    plastics = select(study.materials, category=PLASTICS)
    rows = study.experiments["absorption"]
    size, relative = (
        settings_of([row for row in rows if row["quantity"] == quantity]) for quantity in ("rmse", "relative")
    )
    return Finding(
        [*claims(study.errors.table(), study.materials), *_grey_claims(size)],
        [
            "As declared, C and A differ in colour more than in size: τ is (0.05, 0.1, 0.8) or 0.2, ρ is (0.1, 0.6, "
            "0.1) or 0.5.",
            study.rmse_table(plastics, MODELS),
            "Hence a second look with both grey and varied one at a time (α₀ = 0.05). RMSE [sr^-1/2], and relative to "
            "the norm of the simulation:",
            _varied({"RMSE": size, "relative": relative}),
        ],
        because=_BECAUSE,
        remarks=[_REMARK],
    )


_BECAUSE = (
    "with absorption the light that comes back from the base fades, and the error with it. With grey τ it falls, "
    "except from τ = 0 to 0.1 over a bright base, where inter-reflections had hidden it. From A to C it grows only "
    "where red and green, which C absorbs less than A, outweigh blue"
)
_REMARK = (
    "With other numbers for A and C (table at the end) the error falls with the mean of τ whenever A and C differ "
    "clearly in it. The convention matters as well: for the luminance, or the root of the mean square of the channels, "
    "the declared τ gives a larger error with C in all comparisons. Relative to the light that is left, the error over "
    "a bright base (ρ = 0.9) grows with τ and levels off, that of ww09 over a dark one falls, and both fall with ρ. "
    "Inter-reflections, which the "
    "paper holds responsible, work the other way: the models lack the factor 1/1.5² of the solid angle (Section 5.1), "
    "a constant, and inter-reflections brighten the simulation towards them."
)


def _grey_claims(size):
    """Claims on the experiment: ``size`` is a dict of tau to a dict of (rho, model) to `Value`."""
    taus, rhos = list(size), list(dict.fromkeys(rho for rho, _ in next(iter(size.values()))))
    with_rho, with_tau = {}, {}
    for model in MODELS:
        for tau in taus:
            for low, high in pairwise(rhos):
                with_rho[f"{model}, {tau}, {low} to {high}"] = less(size[tau][low, model], size[tau][high, model])
        for rho in rhos:
            for low, high in pairwise(taus):
                with_tau[f"{model}, {rho}, {low} to {high}"] = less(size[low][rho, model], size[high][rho, model])
    return [Claim("grows with grey ρ", with_rho), Claim("grows with grey τ", with_tau)]


def _varied(found):
    """Table of both quantities: rows by model, quantity and rho, columns by tau."""
    taus = list(found["RMSE"])
    keys = list(found["RMSE"][taus[0]])
    rows = [
        [f"{model}, {rho}, {word}", *(number(by_tau[tau][rho, model]) for tau in taus)]
        for word, by_tau in found.items()
        for rho, model in sorted(keys, key=lambda key: key[1])
        if model in MODELS
    ]
    return table(["", *taus], rows)
