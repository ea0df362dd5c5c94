"""What every finding is given, and what it hands back."""

from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from .errors import Errors
from .markdown import number, table
from .slices import Slices
from .verdicts import NOT_REPRODUCED, overall


@dataclass(frozen=True)
class Study:
    """The material of the study.

    Attributes
    ----------
    results : Path
        Folder of the 60 results, with ``comparison/`` below it.
    errors : Errors
    experiments : dict of str to list of dict
        Rows of every experiment by its name, values as text.
    pictures : Path
        Folder for figures.
    """

    results: Path
    errors: Errors
    experiments: dict
    pictures: Path

    @property
    def materials(self):
        """All materials."""
        return self.errors.materials

    def slices(self, material):
        """Simulated and integrated slices; the last few are kept."""
        return _slices(self.results, material)

    def shown(self, material, model):
        """The error of a model as text, or its upper limit where it is not told from noise."""
        row = self.errors.row(material, model)
        if row.get("below_noise") == "1":
            return f"< {float(row['rmse_upper']):.2g}"
        return number(self.errors.rmse(material, model))

    def rmse_table(self, materials, models):
        """A table of errors, one row for each material and one column for each model."""
        rows = [[m.label, *_roughness(m), *(self.shown(m, model) for model in models)] for m in materials]
        head = ["material", "α₀", "α₁"] if materials[0].alpha1 is not None else ["material", "α₀"]
        return table([*head, *models], rows)


@dataclass(frozen=True)
class Finding:
    """One finding, measured.

    Attributes
    ----------
    claims : list of Claim
    body : list of str
        Paragraphs, tables and pictures in Markdown, shown before the verdict.
    because : str
        Why it is not reproduced, where that is the verdict: a continuation of the sentence.
    remarks : list of str
        Paragraphs after the verdict.
    """

    claims: list
    body: list
    because: str = ""
    remarks: list = field(default_factory=list)

    @property
    def verdict(self):
        """The verdict, by the rules of `verdicts`."""
        return overall(self.claims)

    def verdict_line(self):
        """The sentence with the verdict in bold."""
        because = f", because {self.because}" if self.because and self.verdict == NOT_REPRODUCED else ""
        return f"Verdict: **{self.verdict}**{because}."


def name_of(material):
    """Short name of a material: ``M4 0.2/0.001``."""
    alphas = "/".join(f"{alpha:g}" for alpha in (material.alpha0, material.alpha1) if alpha is not None)
    return f"{material.label} {alphas}"


def _roughness(material):
    return [f"{alpha:g}" for alpha in (material.alpha0, material.alpha1) if alpha is not None]


@lru_cache(maxsize=2)
def _slices(results, material):
    return Slices(results, material)
