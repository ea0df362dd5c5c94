"""Top views side by side: the reference and the models, as in Figs. 5 to 9 of Bati et al. 2019."""

import numpy as np
from matplotlib.figure import Figure

from ...compare.measures import rmse
from .. import text
from ..drawing import panels, tone, view
from ..drawing.legend import title

PIXELS = 220
# Inches.
DISK, LEFT, HEADER, ROW, FOOTER = 1.42, 0.5, 0.85, 1.68, 0.35


def views_figure(comparison, directions):
    """Draw the main component from above, a row for each direction: the simulation, then the models.

    Parameters
    ----------
    comparison : goniosim.compare.material.MaterialComparison
    directions : sequence of int

    Returns
    -------
    matplotlib.figure.Figure
    """
    component = comparison.components[0]
    bsdf, _ = comparison.reference(component)
    columns = [("simulation", bsdf, None)]
    found = {one.variant: one for one in comparison.compared if one.component == component}
    for variant in comparison.variants:
        columns.append((variant.label, comparison.bsdf(variant.label, component), found[variant].measures))
    step = DISK * panels.DISK_ASPECT
    width = max(LEFT + step * len(columns) + 0.2, 6.0)
    figure = Figure(figsize=(width, HEADER + ROW * len(directions) + FOOTER))
    title(figure, f"{comparison.result.name},  {component}")
    for row, m in enumerate(directions):
        _row(figure, HEADER + ROW * row, step, comparison, m, columns, is_first=row == 0)
    figure.text(
        0.5,
        0.12 / figure.get_figheight(),
        "colour by log(1 + √f), a scale for each row, set by the simulation; below: RMSE of the direction",
        ha="center",
        fontsize=8.5,
        color="0.3",
    )
    return figure


def _row(figure, top, step, comparison, m, columns, is_first):
    result = comparison.result
    theta_deg = float(result.theta_deg[m])
    numbers = view.disk(result.cells, m, theta_deg, PIXELS)
    white = tone.white_point(panels.pixel_values(columns[0][1][m], numbers)[numbers >= 0])
    for column, (label, values, measures) in enumerate(columns):
        axes = panels.place(figure, LEFT + column * step, top, step, DISK)
        panels.top_view(axes, values[m], numbers, theta_deg, white)
        if is_first:
            # The options of a second reading go on a line of their own.
            axes.set_title(label.rstrip("]").replace("[", "\n"), fontsize=7.5, x=panels.DISK_CENTRE, pad=3)
        if measures is not None:
            axes.text(0.0, -1.09, _error(rmse(measures, m)), fontsize=7, color="0.3", ha="center", va="top")
    height = figure.get_figheight()
    x, y = 0.12 / figure.get_figwidth(), 1.0 - (top + 0.5 * DISK) / height
    figure.text(x, y, f"{text.degrees(theta_deg)}°", fontsize=10, va="center")


def _error(error):
    return f"{error.rmse:.3g}" if error.significant else f"< {np.format_float_scientific(error.upper, 1)}"
