"""Finding 1: which of the Weidlich-Wilkie family is best on plastics."""

from ..materials import PLASTICS, select
from ..study import Finding
from ..verdicts import Claim
from .answers import ordered

TITLE = "On plastics ww09 beats elek10, and Eq. 5 beats both"
PAPER = (
    "Weidlich and Wilkie's model has a smaller RMSE than Elek's on all plastics (Section 4.2, Fig. 4a), and the "
    "variant of Eq. 5 a smaller one than both on every one of them (Section 5.1, Fig. 4)."
)
MODELS = ("ww09", "elek10", "bati19_ww")


def claims(table, materials):
    """Claims on a table of errors: dict of (material name, model) to `Value`."""
    plastics = select(materials, category=PLASTICS)
    pairs = (("ww09", "elek10"), ("bati19_ww", "ww09"), ("bati19_ww", "elek10"))
    return [Claim(f"{lower} < {higher}", ordered(table, plastics, lower, higher)) for lower, higher in pairs]


def measure(study):
    """The `Finding`."""
    plastics = select(study.materials, category=PLASTICS)
    return Finding(claims(study.errors.table(), study.materials), [study.rmse_table(plastics, MODELS)])
