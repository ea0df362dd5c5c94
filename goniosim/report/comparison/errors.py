"""The error of every model on every material, after Fig. 4 of Bati et al. 2019."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import NullFormatter

from ...compare.summary import CATEGORIES
from ..drawing import panels
from ..drawing.legend import title
from . import legend, style
from .labels import short_names

# Inches.
LEFT, GAP, FOOTER = 0.95, 0.3, 0.15
PANEL_HEIGHT, PANEL_TOP, PER_MATERIAL, NARROWEST = 2.5, 0.45, 0.34, 1.5
# Below a panel stand the names, at a slant: room in any case, and for each letter.
NAMES, LETTER = 0.4, 0.06

COMPONENTS = {
    "reflection/internal": "internal paths",
    "transmission": "transmission",
    "reflection": "reflection off a single interface",
}


def errors_figure(summaries):
    """Draw the RMSE per material on a logarithmic scale, one panel for each alpha0.

    Parameters
    ----------
    summaries : list of goniosim.compare.summary.Summary

    Returns
    -------
    matplotlib.figure.Figure
    """
    rows = [
        (category, _by_alpha(summaries, category))
        for category in CATEGORIES
        if any(summary.category == category and summary.overall() for summary in summaries)
    ]
    widths = [[max(NARROWEST, PER_MATERIAL * (len(group) + 1)) for _, group in groups] for _, groups in rows]
    width = max(LEFT + max(sum(row) + GAP * len(row) for row in widths), 8.5)
    heights = [PANEL_TOP + PANEL_HEIGHT + NAMES + LETTER * _longest(groups) for _, groups in rows]
    handles = _handles(summaries)
    top = legend.height_needed(width, len(handles))
    figure = Figure(figsize=(width, top + sum(heights) + FOOTER))
    title(figure, "Error of published models against the simulation")
    legend.place(figure, handles)
    for (category, groups), row_widths, row_height in zip(rows, widths, heights, strict=True):
        stretch = (width - LEFT - GAP * len(row_widths)) / sum(row_widths)
        _row(figure, top, category, groups, [stretch * panel for panel in row_widths])
        top += row_height
    return figure


def _by_alpha(summaries, category):
    """(alpha0, materials) in ascending order; materials of the same base roughness stand together."""
    chosen = [summary for summary in summaries if summary.category == category and summary.overall()]
    alphas = sorted({summary.alpha0 for summary in chosen})
    return [
        (alpha, sorted((s for s in chosen if s.alpha0 == alpha), key=lambda s: (s.alpha_base, s.name)))
        for alpha in alphas
    ]


def _names(group):
    return short_names([summary.name for summary in group])


def _longest(groups):
    return max(len(name) for _, group in groups for name in _names(group))


def _row(figure, top, category, groups, widths):
    height = figure.get_figheight()
    shown = {COMPONENTS[summary.component]: None for _, group in groups for summary in group}
    title = f"{category.capitalize()}: {', '.join(shown)}"
    figure.text(
        0.2 / figure.get_figwidth(), 1.0 - (top + 0.02) / height, title, fontsize=10.5, fontweight="bold", va="top"
    )
    low, high = _range([summary for _, group in groups for summary in group])
    left = LEFT
    for number, ((alpha, group), width) in enumerate(zip(groups, widths, strict=True)):
        axes = panels.place(figure, left, top + PANEL_TOP, width, PANEL_HEIGHT)
        _panel(axes, group)
        axes.set_yscale("log")
        axes.set_ylim(low, high)
        if high > 20.0 * low:
            axes.yaxis.set_minor_formatter(NullFormatter())
        axes.set_title(f"α₀ = {alpha:g}", fontsize=9.5, pad=4)
        if number == 0:
            axes.set_ylabel("RMSE [sr$^{-1/2}$]")
        else:
            axes.tick_params(which="both", labelleft=False)
        left += width + GAP


def _panel(axes, group):
    places = np.arange(len(group))
    for place, summary in zip(places, group, strict=True):
        floor = summary.overall()[0]["noise_floor"]
        axes.fill_between([place - 0.5, place + 0.5], 1e-12, max(floor, 1e-12), color="0.88", linewidth=0.0)
    variants = style.spread_out([variant for summary in group for variant in summary.variants])
    for number, variant in enumerate(variants):
        shift = 0.5 * (number / max(len(variants) - 1, 1) - 0.5)
        line = []
        for place, summary in zip(places, group, strict=True):
            for row in summary.overall():
                if summary.label_of(row) == variant.label:
                    _point(axes, place + shift, row, variant)
                    line.append((place + shift, row["rmse_upper" if row["below_noise"] else "rmse"]))
        axes.plot(
            *zip(*line, strict=True),
            color=style.colour(variant),
            alpha=0.35,
            linewidth=0.7,
            linestyle=style.line_style(variant),
            zorder=2,
        )
    axes.set_xlim(-0.6, len(group) - 0.4)
    axes.set_xticks(places, _names(group), rotation=60, ha="right", rotation_mode="anchor", fontsize=7)
    axes.grid(axis="y", color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _point(axes, x, row, variant):
    colour = style.colour(variant)
    look = {"color": colour, "marker": style.marker(variant), "markersize": 4.2, "zorder": 4}
    if variant.options:
        look |= {"markerfacecolor": "white", "markeredgewidth": 0.9}
    if row["below_noise"]:
        # An upper limit: a bar with an arrow downwards.
        axes.plot([x], [row["rmse_upper"]], marker="_", markersize=6, color=colour, zorder=4)
        arrow = {"arrowstyle": "->", "color": colour, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", (x, 0.55 * row["rmse_upper"]), (x, row["rmse_upper"]), arrowprops=arrow)
        return
    # Bars of the length of one standard error are mostly smaller than the marker.
    axes.errorbar([x], [row["rmse"]], yerr=[row["rmse_stderr"]], elinewidth=0.9, linestyle="", **look)
    if not row["converged"] and row["rmse_converged"] > 0.0:
        axes.plot([x, x], [row["rmse"], row["rmse_converged"]], color=colour, linewidth=0.8, zorder=3)
        axes.plot([x], [row["rmse_converged"]], marker="x", markersize=4.5, color=colour, zorder=4)


def _range(summaries):
    rows = [row for summary in summaries for row in summary.overall()]
    values = [row["rmse_upper"] if row["below_noise"] else row["rmse"] for row in rows]
    values += [row["rmse_converged"] for row in rows if not row["below_noise"]]
    values = [value for value in values if value > 0.0] or [1.0]
    low = min([*values, *(row["noise_floor"] for row in rows if row["noise_floor"] > 0.0)])
    return 0.5 * low, 2.0 * max(values)


def _handles(summaries):
    rows = [row for summary in summaries for row in summary.overall()]
    handles = []
    for variant in style.spread_out([variant for summary in summaries for variant in summary.variants]):
        face = {"markerfacecolor": "white"} if variant.options else {}
        handles.append(
            Line2D(
                [],
                [],
                color=style.colour(variant),
                marker=style.marker(variant),
                markersize=5,
                linestyle=style.line_style(variant),
                linewidth=0.8,
                label=variant.label,
                **face,
            )
        )
    handles.append(Patch(facecolor="0.88", label="noise floor of the simulation"))
    if any(row["below_noise"] for row in rows):
        label = "below noise: upper limit"
        handles.append(Line2D([], [], color="0.3", marker="_", linestyle="", label=label))
    if not all(row["converged"] for row in rows):
        handles.append(Line2D([], [], color="0.3", marker="x", linestyle="", label="converged integration"))
    return handles
