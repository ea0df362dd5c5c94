"""The error of every model on every material, after Fig. 4 of Bati et al. 2019."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from ...compare.summary import CATEGORIES
from ..drawing import letters, panels
from ..drawing.legend import title
from . import labels, legend, style, ticks
from .labels import short_names

# Inches.
LEFT, GAP, FOOTER = 1.05, 0.3, 0.15
PANEL_HEIGHT, PANEL_TOP, PANEL_TITLE, NARROWEST, NARROWEST_FIGURE, WIDEST = 2.6, 0.3, 0.2, 1.5, 8.5, 14.0
# Each material has room for a mark of each model; its name takes room as well.
PER_MARK, BETWEEN, NAME_LINE = 0.085, 0.14, 0.14
# Below a panel stand the names, at a slant of 60 degrees.
NAMES, NAME_SIZE, LONGEST_NAME, SLANT = 0.35, 7.0, 1.7, np.sin(np.radians(60.0))
SIGMAS = 2.0
NOISE = "noise of the simulation, taken out: marks in it are significant"
BAND, FLOOR = "0.92", "0.6"

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
    rows = [(category, line) for category in CATEGORIES for line in _lines(_by_alpha(summaries, category))]
    full = LEFT + max(sum(map(_width, line)) + GAP * len(line) for _, line in rows)
    width = min(max(full, NARROWEST_FIGURE), WIDEST)
    handles = _handles(summaries)
    top = legend.height_needed(width, handles)
    heights = [_height(line) for _, line in rows]
    figure = Figure(figsize=(width, top + sum(heights) + FOOTER))
    title(figure, "Error of published models against the simulation")
    legend.place(figure, handles)
    for number, ((category, line), height) in enumerate(zip(rows, heights, strict=True)):
        first = number == 0 or rows[number - 1][0] != category
        _row(figure, top, category if first else "", line, _limits(summaries, category))
        top += height
    return figure


def _lines(groups):
    """Panels that stand side by side: as many as there is room for."""
    lines, room = [], 0.0
    for group in groups:
        taken = _width(group) + GAP
        if not lines or room + taken > WIDEST - LEFT:
            lines.append([])
            room = 0.0
        lines[-1].append(group)
        room += taken
    return lines


def _width(group):
    """Width in inches that a panel wants."""
    _, materials = group
    marks = max(len(summary.variants) for summary in materials)
    names = max(name.count("\n") + 1 for name in _names(materials))
    each = max(PER_MARK * marks + BETWEEN, NAME_LINE * (names + 1))
    return max(NARROWEST, each * (len(materials) + 0.2))


def _height(line):
    longest = max(letters.width(name, NAME_SIZE) for _, materials in line for name in _names(materials))
    lines = max(name.count("\n") + 1 for _, materials in line for name in _names(materials))
    return PANEL_TOP + PANEL_TITLE + PANEL_HEIGHT + NAMES + SLANT * longest + 0.5 * NAME_LINE * lines


def _by_alpha(summaries, category):
    """(alpha0, materials) in ascending order; materials of the same base roughness stand together."""
    chosen = [summary for summary in summaries if summary.category == category and summary.overall()]
    alphas = sorted({summary.alpha0 for summary in chosen})
    return [
        (alpha, sorted((s for s in chosen if s.alpha0 == alpha), key=lambda s: (s.alpha_base, s.name)))
        for alpha in alphas
    ]


def _names(group):
    names = short_names([summary.name for summary in group])
    return [letters.broken(name, NAME_SIZE, LONGEST_NAME) for name in names]


def _row(figure, top, category, line, limits):
    width, height = figure.get_size_inches()
    shown = {COMPONENTS[summary.component]: None for _, group in line for summary in group}
    if category:
        words = f"{category.capitalize()}: {', '.join(shown)}"
        figure.text(0.2 / width, 1.0 - (top + 0.02) / height, words, fontsize=10.5, fontweight="bold", va="top")
    wanted = [_width(group) for group in line]
    stretch = (width - LEFT - GAP * len(line)) / sum(wanted)
    left = LEFT
    for number, ((alpha, group), panel) in enumerate(zip(line, wanted, strict=True)):
        axes = panels.place(figure, left, top + PANEL_TOP + PANEL_TITLE, stretch * panel, PANEL_HEIGHT)
        ticks.logarithmic(axes, "y", *limits)
        _panel(axes, group, stretch * panel)
        axes.set_title(f"α₀ = {alpha:g}", fontsize=9.5, pad=4)
        if number == 0:
            axes.set_ylabel(f"RMSE [{labels.UNIT}]")
        else:
            axes.tick_params(which="both", labelleft=False)
        left += stretch * panel + GAP


def _panel(axes, group, width):
    places = np.arange(len(group))
    lowest = axes.get_ylim()[0]
    for place, summary in zip(places, group, strict=True):
        floor = max(summary.overall()[0]["noise_floor"], 0.1 * lowest)
        sides = [place - 0.47, place + 0.47]
        axes.fill_between(sides, 0.1 * lowest, floor, color=BAND, linewidth=0.0)
        axes.plot(sides, [floor, floor], color=FLOOR, linewidth=0.8, linestyle=":", zorder=2)
    variants = style.spread_out([variant for summary in group for variant in summary.variants])
    # Side by side, but not further apart than it takes.
    spread = min(0.84, 0.2 * len(variants) * len(group) / width)
    for number, variant in enumerate(variants):
        shift = spread * ((number + 0.5) / len(variants) - 0.5)
        line = []
        for place, summary in zip(places, group, strict=True):
            for row in summary.overall():
                if summary.label_of(row) == variant.label:
                    _point(axes, place + shift, row, variant)
                    line.append((place + shift, row["rmse_upper" if row["below_noise"] else "rmse"]))
        axes.plot(*zip(*line, strict=True), alpha=0.4, zorder=3, **style.of(variant).line(0.7))
    axes.set_xlim(-0.6, len(group) - 0.4)
    look = {"rotation": 60, "ha": "right", "rotation_mode": "anchor", "fontsize": NAME_SIZE, "parse_math": False}
    axes.set_xticks(places, _names(group), **look)
    axes.grid(axis="y", color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _point(axes, x, row, variant):
    look = style.of(variant)
    colour = look.colour
    if row["below_noise"]:
        # An upper limit: a bar with an arrow downwards, and no mark.
        axes.plot([x], [row["rmse_upper"]], marker="_", markersize=6, color=colour, zorder=4)
        arrow = {"arrowstyle": "->", "color": colour, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", (x, 0.55 * row["rmse_upper"]), (x, row["rmse_upper"]), arrowprops=arrow)
        return
    low = max(row["rmse"] - SIGMAS * row["rmse_stderr"], 0.1 * axes.get_ylim()[0])
    bar = [[row["rmse"] - low], [SIGMAS * row["rmse_stderr"]]]
    axes.errorbar([x], [row["rmse"]], yerr=bar, ecolor=colour, elinewidth=1.0, capsize=2.2, linestyle="", zorder=4)
    if not row["converged"] and row["rmse_converged"] > 0.0:
        axes.plot([x, x], [row["rmse"], row["rmse_converged"]], color=colour, linewidth=0.8, zorder=3)
        axes.plot([x], [row["rmse_converged"]], marker="x", markersize=4.5, color=colour, zorder=4)
    # The halo lifts a mark out of the band: an error from which the noise was taken may lie far below it.
    halo = [withStroke(linewidth=2.6, foreground="white")]
    axes.plot([x], [row["rmse"]], linestyle="", zorder=5, path_effects=halo, **look.mark(4.6))


def _limits(summaries, category):
    """Limits of all panels of a category."""
    return _range([summary for summary in summaries if summary.category == category and summary.overall()])


def _range(summaries):
    rows = [row for summary in summaries for row in summary.overall()]
    values = [row["rmse_upper"] if row["below_noise"] else row["rmse"] for row in rows]
    values += [row["rmse_converged"] for row in rows if not row["below_noise"]]
    values = [value for value in values if value > 0.0] or [1.0]
    values += [row["rmse"] + SIGMAS * row["rmse_stderr"] for row in rows if not row["below_noise"]]
    low = min([*values, *(row["noise_floor"] for row in rows if row["noise_floor"] > 0.0)])
    return 0.5 * low, 2.0 * max(values)


def _handles(summaries):
    rows = [row for summary in summaries for row in summary.overall()]
    variants = style.spread_out([variant for summary in summaries for variant in summary.variants])
    handles = [
        Line2D([], [], label=variant.label, **style.of(variant).mark(5.0) | style.of(variant).line(0.9))
        for variant in variants
    ]
    look = {"color": "0.3", "linestyle": ""}
    handles.append(Line2D([], [], marker="|", markersize=9, label=f"± {SIGMAS:g} standard errors", **look))
    handles.append(Patch(facecolor=BAND, edgecolor=FLOOR, linestyle=":", label=NOISE))
    if any(row["below_noise"] for row in rows):
        handles.append(Line2D([], [], marker="_", label="below noise: upper limit", **look))
    if not all(row["converged"] for row in rows):
        handles.append(Line2D([], [], marker="x", label="converged integration", **look))
    return handles
