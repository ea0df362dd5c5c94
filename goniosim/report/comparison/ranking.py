"""The ranking of the models as text."""

from .. import text
from .labels import error_text

UNIT = "[sr^-1/2]"


def ranking(summaries):
    """Rank the models on every material by their error.

    Parameters
    ----------
    summaries : list of goniosim.compare.summary.Summary

    Returns
    -------
    str
    """
    blocks = [_material(summary) for summary in summaries]
    blocks.append(_explanation([row for summary in summaries for row in [*summary.overall(), *_totals(summary)]]))
    return "\n\n".join("\n".join(lines) for lines in blocks)


def _material(summary):
    rows = sorted(summary.overall(), key=lambda row: row["rmse_converged"])
    lines = [f"{summary.name}  ({summary.component})"]
    if rows:
        header = [
            "model",
            f"RMSE\n{UNIT}",
            "relative\nRMSE",
            f"converged\n{UNIT}",
            "albedo\nerror",
            "time per\nslice",
            f"RMSE of all\nreflection {UNIT}",
        ]
        total = {summary.label_of(row): row for row in _totals(summary)}
        same = summary.component == "reflection"
        table = [_cells(summary, row, None if same else total.get(summary.label_of(row))) for row in rows]
        if same:
            header, table = header[:-1], [cells[:-1] for cells in table]
        lines += text.table(header, table)
        first = rows[0]
        floor = f"noise floor {first['noise_floor']:.2e} sr^-1/2" if first["noise_floor"] > 0.0 else "not hit once"
        lines.append(
            f"  simulation: {floor} after {text.count(first['rays'])} rays and "
            f"{text.duration(first['simulation_seconds'])} per direction"
        )
    return lines + _not_applicable(summary)


def _not_applicable(summary):
    """One line for each reason why models do not apply."""
    models = {}
    for row in summary.rows:
        if row["note"] is not None:
            models.setdefault(row["note"], []).append(row["model"])
    return [f"  n/a: {', '.join(names)}: {reason}" for reason, names in models.items()]


def _totals(summary):
    """Rows of all reflection, direct and internal."""
    return [
        row
        for row in summary.rows
        if (row["component"], row["channel"], row["theta_deg"], row["note"]) == ("reflection", "mean", "all", None)
    ]


def _cells(summary, row, total):
    relative = row["rmse_relative"]
    return [
        summary.label_of(row),
        _error(row),
        "" if relative is None or row["below_noise"] else f"{relative:.3g}",
        _converged(row),
        text.with_error(row["albedo_error"], row["albedo_reference_stderr"]),
        text.duration(row["model_seconds"]),
        "" if total is None else _error(total),
    ]


def _error(row):
    return error_text(row["rmse"], row["rmse_stderr"], row["rmse_upper"], not row["below_noise"], row["converged"])


def _converged(row):
    if row["converged"]:
        return "yes"
    mark = "**" if row["integration"] == "exhausted" else "*"
    return f"{mark} {row['rmse_converged']:.4g}"


def _explanation(rows):
    lines = [
        "RMSE in sr^-1/2: Eq. 4 of Bati et al. 2019 over all directions, mean over the channels, less the",
        "noise of the simulation; 'below noise': less than two standard errors, or than what so few hits can hide,",
        "and the limit at 97.7 %.",
    ]
    if not all(row["converged"] for row in rows):
        lines.append(
            "*: the sub-cells are too coarse for this lobe; the converged error stands beside it, or in errors.csv."
        )
    if any(row["integration"] == "exhausted" for row in rows):
        lines.append("**: this lobe was given up before it was integrated to convergence: trust neither error.")
    return lines
