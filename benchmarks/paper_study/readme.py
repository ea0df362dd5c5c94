"""The tables that README.md shows: between two markers, never by hand."""

import re

import numpy as np

from .errors import StudyError
from .markdown import table
from .materials import METALS, PLASTICS, SLABS, select
from .verdicts import CANNOT_TELL, NOT_REPRODUCED, REPRODUCED

BEGIN = "<!-- written by `make paper` -->"
END = "<!-- end of what `make paper` writes -->"
GROUPS = {
    "12 plastics": {"category": PLASTICS},
    "18 metals, rough base": {"category": METALS, "alpha1": 0.2},
    "18 metals, smooth base": {"category": METALS, "alpha1": 0.001},
    "6 slabs, rough base": {"category": SLABS, "alpha1": 0.2},
    "6 slabs, smooth base": {"category": SLABS, "alpha1": 0.001},
}
MODELS = ("ww09", "elek10", "bati19_ww", "belcour18_forward", "belcour18_symmetric", "bati19_belcour")


def write(study, findings, path):
    """Put the tables between the markers of a file.

    Parameters
    ----------
    study : Study
    findings : list of (module, Finding)
    path : Path
    """
    before = path.read_text(encoding="utf-8")
    after = replaced(before, "\n\n".join([medians(study), verdicts(findings)]))
    if after != before:
        path.write_text(after, encoding="utf-8")


def replaced(text, content):
    """The text with new content between its markers.

    Raises
    ------
    StudyError
        There is not exactly one pair of markers.
    """
    pattern = re.compile(f"({re.escape(BEGIN)}\n).*?({re.escape(END)})", re.DOTALL)
    if len(pattern.findall(text)) != 1:
        raise StudyError(f"README.md: must hold {BEGIN} and {END} once each; put them back")
    return pattern.sub(lambda match: f"{match[1]}{content}\n{match[2]}", text)


def medians(study):
    """Median RMSE of every model over groups of materials."""
    rows = []
    for name, properties in GROUPS.items():
        group = select(study.materials, **properties)
        cells = []
        for model in MODELS:
            found = [study.errors.rmse(m, model).value for m in group if model in study.errors.models(m)]
            cells.append(f"{np.median(found):.2g}" if found else "")
        rows.append([name, *cells])
    return table(["median RMSE [sr^-1/2]", *MODELS], rows)


def verdicts(findings):
    """One line that counts the verdicts, and a list of those that are not reproduced."""
    found = [finding.verdict for _, finding in findings]
    counts = ", ".join(f"{found.count(word)} {word}" for word in (REPRODUCED, NOT_REPRODUCED, CANNOT_TELL))
    others = [
        f"* {number}. {module.TITLE}: {finding.verdict}"
        for number, (module, finding) in enumerate(findings, 1)
        if finding.verdict != REPRODUCED
    ]
    head = f"Of the paper's {len(found)} written findings: {counts}."
    return "\n".join([head, "", *others]) if others else head
