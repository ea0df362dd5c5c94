"""The table of errors: one row for each material, model, component, channel and direction."""

import math

from .measures import rmse

# Column: unit and meaning.
COLUMNS = {
    "material": ("", "name of the material"),
    "model": ("", "name of the model"),
    "options": ("", "options of the model that are not at their default"),
    "component": ("", "component of the scattered light"),
    "channel": ("", "colour channel; mean: mean over the channels"),
    "theta_deg": ("degree", "incident direction; all: Eq. 4 of Bati et al. 2019, over all directions"),
    "rmse": ("sr-0.5", "error of the model, the noise of the reference taken out"),
    "rmse_stderr": ("sr-0.5", "standard error of rmse"),
    "rmse_upper": ("sr-0.5", "the error of the model lies below with 97.7 % confidence"),
    "below_noise": (
        "",
        "1: noise at two standard errors, or light that went unseen (3/rays), explains the error: rmse means nothing",
    ),
    "rmse_eq4": ("sr-0.5", "Eq. 4 as it stands, noise included"),
    "noise_floor": ("sr-0.5", "Eq. 4 of a perfect model: the noise of the reference"),
    "rmse_relative": ("1", "rmse over reference_norm; empty in the dark"),
    "reference_norm": ("sr-0.5", "root of the integral of the squared reference: the scale of rmse_relative"),
    "rmse_finer": ("sr-0.5", "rmse with sub-cells three times as fine along each side"),
    "rmse_converged": ("sr-0.5", "rmse with adaptive integration of the model"),
    "converged": ("", "0: sub-cells change the RMSE by more than 2 %, see rmse_converged, or integration is exhausted"),
    "integration": ("", "what rmse_converged took: fixed (nothing was suspicious), adaptive, exhausted (given up)"),
    "albedo_reference": ("1", "energy of the reference in the valid cells"),
    "albedo_reference_stderr": ("1", "standard error of albedo_reference; 1.5/rays where no path arrived"),
    "albedo_model": ("1", "energy of the model in the valid cells"),
    "albedo_error": ("1", "albedo_model minus albedo_reference"),
    "worst_theta_deg": (
        "degree",
        "incident direction of the cell that adds most to the error, of those that are no noise; empty: there is none",
    ),
    "worst_channel": ("", "its channel"),
    "worst_row": ("1", "its row"),
    "worst_column": ("1", "its column"),
    "worst_difference": ("sr-1", "model minus reference in it"),
    "worst_stderr": ("sr-1", "standard error of the reference in it"),
    "subcells": ("1", "sub-cells along each side of a cell"),
    "model_seconds": ("s", "time of the model per slice, all channels: preparation and integration"),
    "simulation_seconds": ("s", "time of the simulation per incident direction, all components and channels"),
    "rays": ("1", "rays of the simulation per incident direction"),
    "note": ("", "why the model does not apply"),
}


def material_rows(comparison):
    """Rows of one material.

    Parameters
    ----------
    comparison : goniosim.compare.material.MaterialComparison

    Returns
    -------
    list of dict
        With the keys of `COLUMNS`; None where there is nothing to say.
    """
    rows = []
    thetas = comparison.result.theta_deg
    channels = comparison.result.channels
    for found in comparison.compared:
        for direction in [None, *range(len(thetas))]:
            for channel in [None, *range(len(channels))]:
                rows.append(_row(comparison, found, direction, channel))
    for model, reason in comparison.not_applicable.items():
        row = dict.fromkeys(COLUMNS)
        row |= {"material": comparison.result.name, "model": model, "options": ""}
        row |= {"component": comparison.components[0], "channel": "mean", "theta_deg": "all", "note": reason}
        rows.append(row)
    return rows


def label(row):
    """Label of the variant of a row: the model, with its options in brackets."""
    return f"{row['model']}[{row['options']}]" if row["options"] else row["model"]


def error(row):
    """RMSE of a row with its standard error, in a few words."""
    if row["below_noise"]:
        return f"below noise, < {row['rmse_upper']:.2g}"
    value, stderr = row["rmse"], row["rmse_stderr"]
    text = f"{value:.4g}"
    if stderr > 0.0:
        # Two digits of the error, and as many decimals of the value.
        decimals = max(1 - math.floor(math.log10(stderr)), 0)
        text = f"{value:.{decimals}f} ± {stderr:.{decimals}f}"
    return text if row["converged"] else f"{text} ({row['subcells']} x {row['subcells']} sub-cells too coarse)"


def _row(comparison, found, direction, channel):
    result, measures = comparison.result, found.measures
    error = rmse(measures, direction, channel)
    directions = slice(None) if direction is None else slice(direction, direction + 1)
    channels = slice(None) if channel is None else slice(channel, channel + 1)
    reference = measures.albedo_reference[directions, channels]
    stderr = measures.albedo_stderr[directions, channels]
    model = measures.albedo_model[directions, channels]
    norm = float((measures.norm[directions, channels].mean(axis=0) ** 0.5).mean())
    return {
        "material": result.name,
        "model": found.variant.model,
        "options": found.variant.options_text,
        "component": found.component,
        "channel": "mean" if channel is None else result.channels[channel],
        "theta_deg": "all" if direction is None else float(result.theta_deg[direction]),
        "rmse": error.rmse,
        "rmse_stderr": error.stderr,
        "rmse_upper": error.upper,
        "below_noise": int(not error.significant),
        "rmse_eq4": error.raw,
        "noise_floor": error.noise_floor,
        "rmse_relative": error.rmse / norm if norm > 0.0 else None,
        "reference_norm": norm,
        "rmse_finer": rmse(found.finer, direction, channel).rmse,
        "rmse_converged": rmse(found.converged, direction, channel).rmse,
        "converged": int(found.is_converged(direction, channel)),
        "integration": found.integrated(direction),
        "albedo_reference": float(reference.mean()),
        # Directions are independent of each other; channels share their paths.
        "albedo_reference_stderr": float(((stderr**2).sum(axis=0) ** 0.5 / len(stderr)).mean()),
        "albedo_model": float(model.mean()),
        "albedo_error": float((model - reference).mean()),
        **_worst(result, measures, direction, channel),
        "subcells": comparison.subcells,
        "model_seconds": found.seconds,
        "simulation_seconds": comparison.simulation_seconds,
        "rays": float(result.rays.mean()),
        "note": None,
    }


def _worst(result, measures, direction, channel):
    """The columns of the worst cell: of all directions and channels that which adds most; None if there is none."""
    excess = measures.worst_excess
    ms = range(len(excess)) if direction is None else [direction]
    cs = range(excess.shape[1]) if channel is None else [channel]
    m, c = max(((m, c) for m in ms for c in cs), key=lambda place: excess[place])
    if excess[m, c] <= 0.0:
        return dict.fromkeys(name for name in COLUMNS if name.startswith("worst_"))
    return {
        "worst_theta_deg": float(result.theta_deg[m]),
        "worst_channel": result.channels[c],
        "worst_row": int(measures.worst_row[m, c]),
        "worst_column": int(measures.worst_column[m, c]),
        "worst_difference": float(measures.worst_difference[m, c]),
        "worst_stderr": float(measures.worst_stderr[m, c]),
    }
