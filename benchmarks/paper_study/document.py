"""docs/paper_study.md: the findings in order, each with its verdict, and what was varied."""

from goniosim.report import text

from . import chosen, variations
from .findings import FINDINGS
from .markdown import claims_table, failing, table
from .verdicts import YES

INTRODUCTION = """\
# The findings of Bati, Pacanowski and Barla 2019, held against goniosim

The paper ("Numerical Analysis of Layered Material Models", HAL 02157966) compares published models of layered materials
with simulations of 60 materials, at {theirs} rays per direction. This page takes its written findings one by one. The
60 materials are those of [configs/paper](../configs/paper), simulated with {rays} light paths per direction of what
`auto` chooses: their noise is that of {theirs} independent paths or less (`make headline` measures it). The errors are
those of [compare.md](compare.md): RMSE of Eq. 4 for internal paths (plastics, metals) or transmission (slabs), over all
seven directions, mean over the channels, in sr^-1/2, the noise of the simulation taken out, the models integrated to
convergence. The 5 × 5 sub-cells of the paper change {coarse} of these {rows} errors by more than 2 %, up to a factor of
{factor:.1f}.{exhausted} Everything below is written by `make paper`; the rules are in
[benchmarks/paper_study](../benchmarks/paper_study).

**How it is decided.** A claim is one sentence of the paper, made of comparisons, mostly one for each material it speaks
of. A comparison is *yes* or *no* where the numbers tell it at two standard errors, else *open*; a difference is held
against the sum of the two standard errors, which bounds its own whatever noise they share. "Alike" means within a tenth
of a decade, "close" within a factor of two. A claim is reproduced if nine in ten of its comparisons are yes, and cannot
be told if the open ones decide about that. A finding is reproduced if all its claims are, and is not if one of them is
not. Names such as M4 0.2/0.001 stand for the label of the paper's tables and α₀/α₁.
"""


def measure(study):
    """All findings: list of (module, Finding)."""
    return [(module, module.measure(study)) for module in FINDINGS]


def write(study, findings, path):
    """Write the document.

    Parameters
    ----------
    study : Study
    findings : list of (module, Finding)
    path : Path
    """
    parts = [INTRODUCTION.format(**_facts(study.errors)), _summary(findings)]
    parts.append(chosen.TEXT)
    parts += [_section(number, *each) for number, each in enumerate(findings, 1)]
    parts.append(variations.text(study))
    path.write_text("\n\n".join(part.strip("\n") for part in parts) + "\n", encoding="utf-8")


def _facts(errors):
    """Numbers of the introduction."""
    rows = [errors.row(material, model) for material in errors.materials for model in errors.models(material)]
    coarse = [row for row in rows if row["converged"] == "0"]
    exhausted = sum(row.get("integration") == "exhausted" for row in rows)
    ratios = [float(row["rmse_converged"]) / float(row["rmse"]) for row in coarse if float(row["rmse"]) > 0.0]
    return {
        "rays": text.count(errors.smallest_rays()),
        "theirs": text.count(1.6e8),
        "coarse": len(coarse),
        "rows": len(rows),
        "exhausted": f" For {exhausted} the integration was given up (`exhausted`)." if exhausted else "",
        "factor": max((max(ratio, 1.0 / ratio) for ratio in ratios if ratio > 0.0), default=1.0),
    }


def _summary(findings):
    rows = [[f"{number}. {module.TITLE}", finding.verdict] for number, (module, finding) in enumerate(findings, 1)]
    return table(["finding", "verdict"], rows)


def _section(number, module, finding):
    parts = [f"## {number}. {module.TITLE}", f"The paper: {module.PAPER}", *finding.body, claims_table(finding.claims)]
    short = [f"* {claim.text}: {failing(claim)}" for claim in finding.claims if claim.count(YES) < len(claim.answers)]
    if short:
        parts.append("\n".join(["Not *yes*:", "", *short]))
    return "\n\n".join([*parts, finding.verdict_line(), *finding.remarks])
