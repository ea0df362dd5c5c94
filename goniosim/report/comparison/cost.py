"""What accuracy costs: the error of models and of the simulation against the time of a slice."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from ..drawing import letters, panels
from ..drawing.legend import title
from . import legend, style, ticks
from .labels import short_names

# Inches. Right of the plot stand the names of the models, each led to its mark.
LEFT, PLOT, HEIGHT, FOOTER = 0.85, 6.4, 5.0, 0.55
LEAD, NAME_LINE, NAME_SIZE, WIDEST_NAME = 0.45, 0.19, 8.0, 3.6
# Lines of so many materials have their names.
FEW, MATERIAL_SIZE, WIDEST_MATERIAL = 12, 6.5, 1.6
SIMULATION = {"color": "0.5", "linewidth": 0.9, "marker": ".", "markersize": 3.5}


HALO = withStroke(linewidth=2.0, foreground="white")


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
    points = {variant: found for variant in variants if len(found := _points(summaries, variant))}
    lines = {summary.name: found for summary in summaries if len(found := _line(summary))}
    names = max((letters.width(variant.label, NAME_SIZE) for variant in points), default=0.0)
    width = LEFT + PLOT + LEAD + min(names, WIDEST_NAME) + 0.2
    handles = _handles(any(len(found) > 1 for found in points.values()))
    top = legend.height_needed(width, handles)
    height = max(HEIGHT, NAME_LINE * len(points))
    figure = Figure(figsize=(width, top + height + FOOTER))
    title(figure, "Error against cost")
    legend.place(figure, handles)
    axes = panels.place(figure, LEFT, top + 0.05, PLOT, height)
    _furnish(axes, [*points.values(), *lines.values()])
    _simulations(axes, lines)
    for variant, found in points.items():
        look = style.of(variant)
        axes.plot(*found.T, linestyle="", zorder=3, **look.mark(3.5 if len(found) > 1 else 6.5))
        if len(found) > 1:
            axes.plot(
                *np.median(found, axis=0)[:, None],
                linestyle="",
                zorder=5,
                **look.mark(9.0) | {"markeredgecolor": "black"},
            )
    _names(axes, {variant: np.median(found, axis=0) for variant, found in points.items()}, height)
    return figure


def _points(summaries, variant):
    """(seconds, relative error) of a model for each material where its error is no noise."""
    rows = [
        row
        for summary in summaries
        for row in summary.overall()
        if summary.label_of(row) == variant.label
        if row["rmse_relative"] is not None and not row["below_noise"] and row["rmse_converged"] > 0.0
    ]
    # The model's own error, however well the sub-cells catch it.
    return np.array([[row["model_seconds"], row["rmse_converged"] / row["reference_norm"]] for row in rows])


def _line(summary):
    """(seconds, relative noise) of the simulation at its checkpoints."""
    rows = summary.overall()
    norm = rows[0]["reference_norm"] if rows else 0.0
    shown = (summary.seconds > 0.0) & (summary.noise > 0.0) & (norm > 0.0)
    return np.stack([summary.seconds[shown], summary.noise[shown] / (norm or 1.0)], axis=1)


def _furnish(axes, found):
    seconds, errors = np.concatenate(found).T if found else (np.ones(1), np.ones(1))
    ticks.logarithmic(axes, "x", 0.7 * seconds.min(), 1.6 * seconds.max())
    ticks.logarithmic(axes, "y", 0.6 * errors.min(), 1.7 * errors.max())
    axes.set_xlabel("time of one slice, all channels [s]")
    axes.set_ylabel("relative RMSE: over the norm of the reference [1]")
    axes.grid(color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _simulations(axes, lines):
    low, high = np.log(axes.get_xlim())
    names = dict(zip(lines, short_names(list(lines)), strict=True)) if lines else {}
    for name, found in lines.items():
        axes.plot(*found.T, zorder=2, alpha=1.0 if len(lines) <= FEW else 0.4, **SIMULATION)
        if len(lines) <= FEW:
            words = letters.broken(names[name], MATERIAL_SIZE, WIDEST_MATERIAL)
            room = PLOT * (high - np.log(found[-1, 0])) / (high - low) - 0.1
            fits = letters.width(words, MATERIAL_SIZE) <= room
            place = {"ha": "left", "va": "center"} if fits else {"ha": "right", "va": "top"}
            look = {"fontsize": MATERIAL_SIZE, "color": "0.3", "parse_math": False, "path_effects": [HALO]} | place
            axes.annotate(
                words, found[-1], (5, 0) if fits else (-4, -4), textcoords="offset points", zorder=2.5, **look
            )


def _names(axes, marks, height):
    """Write the names of models beside the plot, in the order of their marks, and lead them there."""
    order = sorted(marks, key=lambda variant: marks[variant][1])
    low, high = np.log(axes.get_ylim())
    wanted = [height * (np.log(marks[variant][1]) - low) / (high - low) for variant in order]
    for variant, y in zip(order, _spaced(wanted, NAME_LINE, height), strict=True):
        x, look = 1.0 + LEAD / PLOT, style.of(variant)
        axes.annotate(
            "",
            marks[variant],
            (x - 0.05 / PLOT, y / height),
            textcoords="axes fraction",
            arrowprops={
                "arrowstyle": "-",
                "color": look.colour,
                "linewidth": 0.6,
                "linestyle": look.dash,
                "shrinkA": 0,
            },
            zorder=1,
        )
        words, size = letters.snug(variant.label, NAME_SIZE, WIDEST_NAME)
        look = {"fontsize": size, "va": "center", "linespacing": 1.0, "parse_math": False}
        axes.text(x, y / height, words, transform=axes.transAxes, **look)


def _spaced(wanted, least, height):
    """Ascending places as near to those wanted as a least distance allows, from 0 to ``height``."""
    places = np.array(wanted, dtype=float)
    for number in range(1, len(places)):
        places[number] = max(places[number], places[number - 1] + least)
    if len(places):
        places[-1] = min(places[-1], height)
    for number in range(len(places) - 2, -1, -1):
        places[number] = min(places[number], places[number + 1] - least)
    return places


def _handles(several):
    mark = {"color": "0.35", "marker": "o", "linestyle": ""}
    handles = [Line2D([], [], label="a model on one material", markersize=3.5 if several else 6.5, **mark)]
    if several:
        handles.append(Line2D([], [], label="its median over the materials", markersize=9, **mark))
    handles.append(Line2D([], [], label="simulation of a material: noise floor as rays grow", **SIMULATION))
    return handles
