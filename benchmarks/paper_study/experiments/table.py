"""The table of all experiments: a CSV file beside the results."""

import csv
import os

from ..errors import StudyError, label
from ..verdicts import Value

COLUMNS = ("experiment", "setting", "material", "model", "quantity", "value", "stderr")


def cell(setting, material, model, quantity, found):
    """One row of an experiment; ``found`` is a `Value`."""
    numbers = {"value": f"{found.value:.9g}", "stderr": f"{found.stderr:.9g}"}
    return {"setting": setting, "material": material, "model": model, "quantity": quantity} | numbers


def rmse_rows(comparison, setting, name=label):
    """Rows of an experiment from the overall errors of a comparison.

    Parameters
    ----------
    comparison : goniosim.compare.Comparison
    setting : str
    name : callable
        From a row to the model it stands for.

    Yields
    ------
    dict
    """
    for row in comparison.rows():
        yield cell(setting, row["material"], name(row), "rmse", Value(row["rmse_converged"], row["rmse_stderr"]))


def value_of(row):
    """The number of a row as a `Value`."""
    return Value(float(row["value"]), float(row["stderr"]))


def settings_of(rows):
    """The settings of an experiment in their order, each with its table of errors: (material, model) to `Value`."""
    found = {}
    for row in rows:
        found.setdefault(row["setting"], {})[row["material"], row["model"]] = value_of(row)
    return found


def write(rows, path):
    """Write the rows of all experiments, whole or not at all.

    Parameters
    ----------
    rows : list of dict
    path : Path
    """
    temporary = path.with_name(f".{path.name}.part")
    with open(temporary, "w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    os.replace(temporary, path)


def read(path, names):
    """Rows of every experiment by its name.

    Parameters
    ----------
    path : Path
    names : iterable of str

    Returns
    -------
    dict of str to list of dict of str to str

    Raises
    ------
    StudyError
        There is no such file, or an experiment is missing in it.
    """
    try:
        with open(path, encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
    except OSError as error:
        raise StudyError(f"{path}: cannot be read: {error.strerror}; run the experiments (--experiments)") from error
    found = {name: [row for row in rows if row["experiment"] == name] for name in names}
    missing = [name for name, own in found.items() if not own]
    if missing:
        raise StudyError(f"{path}: lacks {', '.join(missing)}; run the experiments anew (--experiments)")
    return found
