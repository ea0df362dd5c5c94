"""The table of errors as CSV and JSON."""

import csv
import io
import json

from ...compare.rows import COLUMNS
from ...cores import available_cores
from ...provenance import provenance
from ...writing import write_text

FILETYPE = "goniosim-errors"
_ANGLES = ("theta_deg", "worst_theta_deg")
CSV, JSON = "errors.csv", "errors.json"


def origin_of(subcells):
    """Who computed the errors, when and with what, as a dict of str to str."""
    return {**provenance(available_cores()), "subcells": str(subcells)}


def write_csv(path, rows, origin):
    """Write ``errors.csv``: a header and one line per row, nothing else, so that any tool reads it.

    Units and provenance are columns of their own, after those of the errors: ``rmse_unit``,
    ``albedo_unit``, ``angle_unit``, and the keys of ``origin``.

    Parameters
    ----------
    path : Path
    rows : list of dict
        With the keys of `goniosim.compare.rows.COLUMNS`.
    origin : dict of str to str
        From `origin_of`.
    """
    stream = io.StringIO()
    units = {"rmse": "rmse", "albedo": "albedo_model", "angle": "theta_deg"}
    same = {f"{kind}_unit": COLUMNS[column][0] for kind, column in units.items()}
    same |= {name: value for name, value in origin.items() if name not in COLUMNS}
    writer = csv.DictWriter(stream, [*COLUMNS, *same], lineterminator="\n")
    writer.writeheader()
    for row in rows:
        writer.writerow({name: (_angle if name in _ANGLES else _shown)(value) for name, value in row.items()} | same)
    write_text(path, stream.getvalue())


def write_json(path, rows, origin, sources, written):
    """Write ``errors.json``: the same rows with units and provenance.

    Parameters
    ----------
    path, rows, origin
        As in `write_csv`.
    sources : list of dict
        `goniosim.compare.summary.Summary.source` of every material.
    written : list of str
        All files of the report: what the next one may replace or remove.
    """
    head = {
        "filetype": FILETYPE,
        "provenance": origin,
        "columns": {name: {"unit": unit, "meaning": meaning} for name, (unit, meaning) in COLUMNS.items()},
        "results": sources,
        "files": written,
    }
    text = json.dumps(head, indent=1, allow_nan=False)
    lines = ",\n".join(json.dumps(row, allow_nan=False) for row in rows)
    write_text(path, f'{text[:-2]},\n "errors": [\n{lines}\n ]\n}}\n')


def _shown(value):
    if value is None:
        return ""
    return f"{value:.9g}" if isinstance(value, float) else value


def _angle(value):
    """An angle in so many digits that it reads back as the very number, as two may differ in the last one."""
    short = _shown(value)
    return repr(value) if isinstance(value, float) and float(short) != value else short
