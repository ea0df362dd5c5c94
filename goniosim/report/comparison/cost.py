"""What accuracy costs: the error of models and of the simulation against the time of a slice."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..drawing import panels
from ..drawing.legend import title
from . import legend, style

WIDTH, HEIGHT = 8.5, 5.0


def cost_figure(summaries):
    """Draw relative errors against seconds per slice.

    Parameters
    ----------
    summaries : list of goniosim.compare.summary.Summary

    Returns
    -------
    matplotlib.figure.Figure
        One mark for each material and model, a large one for the median of a model; the simulation
        is a line for each material, from its first checkpoint to its last.
    """
    variants = style.spread_out([variant for summary in summaries for variant in summary.variants])
    top = legend.height_needed(WIDTH, len(variants) + 1)
    figure = Figure(figsize=(WIDTH, top + HEIGHT))
    title(figure, "Error against cost")
    axes = panels.place(figure, 0.85, top + 0.05, WIDTH - 1.1, HEIGHT - 0.65)
    for summary in summaries:
        rows = summary.overall()
        norm = rows[0]["reference_norm"] if rows else 0.0
        shown = (summary.seconds > 0.0) & (summary.noise > 0.0)
        if norm > 0.0:
            axes.plot(
                summary.seconds[shown],
                summary.noise[shown] / norm,
                color="0.55",
                linewidth=0.9,
                marker=".",
                markersize=3.5,
                alpha=0.8,
                zorder=2,
            )
    handles = [_model(axes, summaries, variant) for variant in variants]
    handles.append(Line2D([], [], color="0.55", marker=".", label="simulation: noise floor as rays grow"))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("time of one slice, all channels [s]")
    axes.set_ylabel("RMSE relative to the norm of the reference")
    axes.grid(color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    legend.place(figure, handles)
    return figure


def _model(axes, summaries, variant):
    rows = [
        row
        for summary in summaries
        for row in summary.overall()
        if summary.label_of(row) == variant.label
        if row["rmse_relative"] is not None and not row["below_noise"]
    ]
    look = {"color": style.colour(variant), "marker": style.marker(variant), "linestyle": ""}
    if variant.options:
        look["markerfacecolor"] = "white"
    if rows:
        # The model's own error, however well the sub-cells catch it.
        errors = [row["rmse_converged"] / row["reference_norm"] for row in rows]
        seconds = [row["model_seconds"] for row in rows]
        axes.plot(seconds, errors, markersize=3.5, alpha=0.45, zorder=3, **look)
        if len(rows) > 1:
            middle = [np.median(seconds)], [np.median(errors)]
            axes.plot(*middle, markersize=9, markeredgecolor="black", zorder=5, **look)
    return Line2D([], [], label=variant.label, markersize=5, **look)
