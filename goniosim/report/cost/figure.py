"""Error against time, log-log: what each run of the ladder reached in each direction, and the law through them."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from .. import text
from ..comparison import legend, style, ticks
from ..drawing import panels
from ..drawing.legend import title
from .prices import ERRORS, price

SUFFIXES = ("png", "svg")
# Inches.
LEFT, PLOT, GAP, HEIGHT, FOOTER, RIGHT, NAME = 0.85, 4.6, 0.75, 3.9, 0.6, 0.25, 0.25
# Of a law, as a polygon: a logarithmic plot bends it where the part that does not grow begins.
STEPS = 60
LOOKS = {
    "auto": {"color": "#0055a4", "marker": "o", "markersize": 4.5},
    "analog": {"color": "#d55e00", "marker": "s", "markersize": 4.0},
}
# Beyond the last run a law is a prediction.
MEASURED, PREDICTED = "-", (0, (4, 2))


def price_figure(made):
    """Draw a price list.

    Parameters
    ----------
    made : PriceList

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each component that is sampled and not black.
    """
    shown = {name: each for name, each in made.components.items() if any(each.prices.values())}
    width = LEFT + max(len(shown), 1) * (PLOT + GAP) - GAP + RIGHT
    handles = _handles(shown)
    top = legend.height_needed(width, handles) + NAME
    figure = Figure(figsize=(width, top + HEIGHT + FOOTER))
    threads, angles = (
        text.counted(made.threads, "thread"),
        text.counted(len(made.scene.incident.theta_deg), "direction"),
    )
    title(figure, f"{made.scene.material.name}: error against time")
    axes = []
    for number, (name, component) in enumerate(shown.items()):
        left = LEFT + number * (PLOT + GAP)
        axes.append(panels.place(figure, left, top, PLOT, HEIGHT))
        _panel(axes[-1], name, component, made.ladders)
        axes[-1].set_xlabel(f"mean time of one slice, {threads} [s]")
        if number == 0:
            axes[-1].set_ylabel(f"relative slice error, each of {angles} [1]")
    legend.place(figure, handles)
    return figure


def _panel(axes, name, component, ladders):
    points = {each: _points(name, component, rungs, component.laws[each]) for each, rungs in ladders.items()}
    errors = np.concatenate([*(found[1] for found in points.values()), ERRORS])
    curves = {each: _curve(law, errors.min(), errors.max()) for each, law in component.laws.items()}
    marks = _marks(component)
    seen = [
        *points.values(),
        *(curve[:2] for curve in curves.values()),
        *(np.array([each]).T for each in marks.values()),
    ]
    (left, low), (right, high) = (limits(np.concatenate(seen, axis=1), axis=1) for limits in (np.min, np.max))
    ticks.logarithmic(axes, "x", 0.6 * left, 1.7 * right)
    ticks.logarithmic(axes, "y", 0.7 * low, 1.5 * high)
    for each, (seconds, error, unknown, measured) in curves.items():
        colour, factor = LOOKS[each]["color"], 1.0 + unknown
        axes.fill_betweenx(error, seconds / factor, seconds * factor, color=colour, alpha=0.15, linewidth=0.0)
        for part, dash in ((measured > 0.0, MEASURED), (measured == 0.0, PREDICTED)):
            axes.plot(np.where(part, seconds, np.nan), error, color=colour, linestyle=dash, linewidth=1.5)
        axes.plot(*points[each], linestyle="", alpha=0.45, markeredgewidth=0.0, **LOOKS[each])
    for model, place in marks.items():
        axes.plot(*place, linestyle="", **style.look(model).mark(5.5))
    axes.set_title(name, fontsize=9, loc="left", parse_math=False)
    axes.grid(color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _marks(component):
    """Seconds of a slice, and relative error, of each model whose error is told from noise."""
    return {
        model: (point["seconds"] / len(component.norm), point["error"])
        for model, point in component.models.items()
        if point["significant"]
    }


def _points(name, component, rungs, law):
    """Seconds and relative errors of every run in every direction that is lit, shape (2, n)."""
    lit = np.isfinite(law.level)
    overhead = law.overhead[0] / len(lit)
    seconds = np.concatenate([rung.seconds[lit] + overhead for rung in rungs])
    error = np.concatenate([rung.noise[name][lit] / component.norm[lit] for rung in rungs])
    return np.stack([seconds, error])


def _curve(law, low, high):
    """Mean seconds of a slice by error, their relative uncertainty, and whether it was measured, shape (4, n)."""
    found = [price(law, error) for error in np.geomspace(low, high, STEPS)]
    return np.array([[each.seconds / len(law.level), each.error, each.uncertainty, each.measured] for each in found]).T


def _handles(shown):
    names = list(next(iter(shown.values())).laws) if shown else []
    models = dict.fromkeys(model for component in shown.values() for model in _marks(component))
    return [
        *(Line2D([], [], label=f"{name}: a run, one direction", linestyle="", **LOOKS[name]) for name in names),
        Line2D([], [], label="law through the runs", color="0.35", linestyle=MEASURED, linewidth=1.5),
        Line2D([], [], label="predicted", color="0.35", linestyle=PREDICTED, linewidth=1.5),
        Patch(label="± one standard error", facecolor="0.35", alpha=0.2),
        *(Line2D([], [], label=model, linestyle="", **style.look(model).mark(5.5)) for model in models),
    ]
