"""The table of errors as CSV and JSON."""

import csv
import io
import json
import os
from pathlib import Path

from ...compare.rows import COLUMNS
from ...cores import available_cores
from ...errors import OutputError
from ...provenance import provenance

FILETYPE = "goniosim-errors"


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
        writer.writerow({name: _shown(value) for name, value in row.items()} | same)
    _replace(path, stream.getvalue())


def write_json(path, rows, origin, sources):
    """Write ``errors.json``: the same rows with units and provenance.

    Parameters
    ----------
    path, rows, origin
        As in `write_csv`.
    sources : list of dict
        `goniosim.compare.summary.Summary.source` of every material.
    """
    head = {
        "filetype": FILETYPE,
        "provenance": origin,
        "columns": {name: {"unit": unit, "meaning": meaning} for name, (unit, meaning) in COLUMNS.items()},
        "results": sources,
    }
    text = json.dumps(head, indent=1, allow_nan=False)
    lines = ",\n".join(json.dumps(row, allow_nan=False) for row in rows)
    _replace(path, f'{text[:-2]},\n "errors": [\n{lines}\n ]\n}}\n')


def _shown(value):
    if value is None:
        return ""
    return f"{value:.9g}" if isinstance(value, float) else value


def _replace(path, text):
    """Write a text file whole or not at all."""
    temporary = Path(path).with_name(f".{Path(path).name}.part")
    try:
        temporary.write_text(text, encoding="utf-8")
        os.replace(temporary, path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror}; choose another place") from error
