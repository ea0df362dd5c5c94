"""The table of errors that `goniosim compare` wrote: errors.csv, read by the names of its columns."""

import csv
import math
from pathlib import Path

from .materials import parse
from .verdicts import Value

NEEDED = ("material", "model", "options", "component", "channel", "theta_deg", "rmse", "rmse_stderr", "rmse_converged")


class StudyError(Exception):
    """Something that the study needs is missing; the message says what, where and the remedy."""


def read_rows(path):
    """Rows of errors.csv in which a model applies.

    Parameters
    ----------
    path : Path

    Returns
    -------
    list of dict of str to str

    Raises
    ------
    StudyError
        There is no such file, or it lacks a column.
    """
    try:
        with open(path, encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
    except OSError as error:
        raise StudyError(f"{path}: cannot be read: {error.strerror}; run `make paper` first") from error
    missing = [name for name in NEEDED if rows and name not in rows[0]]
    if missing or not rows:
        raise StudyError(f"{path}: has no {', '.join(missing) or 'rows'}; write it anew with `goniosim compare`")
    return [row for row in rows if not row.get("note")]


class Errors:
    """Errors of models on the 60 materials.

    Parameters
    ----------
    rows : list of dict of str to str
        From `read_rows`.

    Attributes
    ----------
    materials : list of Material
    rows : list of dict
        Those of the materials.
    """

    def __init__(self, rows):
        known = {name: parse(name) for name in dict.fromkeys(row["material"] for row in rows)}
        self.materials = [material for material in known.values() if material is not None]
        self.rows = [row for row in rows if known[row["material"]] is not None]
        self._by_key = {_key(row): row for row in self.rows}

    def row(self, material, model, component=None, channel="mean", theta="all"):
        """The row of a model, written as in legends: ``belcour18_forward[jacobian=snell]``.

        Raises
        ------
        StudyError
            There is none.
        """
        theta = theta if theta == "all" else f"{float(theta):g}"
        key = material.name, model, component or material.component, channel, theta
        if key not in self._by_key:
            raise StudyError(f"errors.csv: has no row {', '.join(key)}; compare all models and results")
        return self._by_key[key]

    def rmse(self, material, model, component=None, channel="mean", theta="all"):
        """Error of a model, its noise taken out, with converged integration of the model: a `Value`."""
        row = self.row(material, model, component, channel, theta)
        return Value(float(row["rmse_converged"]), float(row["rmse_stderr"]))

    def models(self, material):
        """Models that apply to a material, as written in legends, in the order of the table."""
        return list(dict.fromkeys(label(row) for row in self.rows if row["material"] == material.name))

    def table(self):
        """The errors of Fig. 4, as a dict of (material name, model) to `Value`."""
        return {
            (material.name, model): self.rmse(material, model)
            for material in self.materials
            for model in self.models(material)
        }

    def smallest_rays(self):
        """Rays per direction of the coarsest simulation."""
        return min((float(row["rays"]) for row in self.rows if row.get("rays")), default=math.nan)


def label(row):
    """Name of the model of a row with its options in brackets."""
    return f"{row['model']}[{row['options']}]" if row["options"] else row["model"]


def _key(row):
    theta = row["theta_deg"]
    return (
        row["material"],
        label(row),
        row["component"],
        row["channel"],
        theta if theta == "all" else f"{float(theta):g}",
    )


def errors_path(results):
    """Where the table of errors stands below the folder of results."""
    return Path(results) / "comparison" / "errors.csv"
