"""Curves in the plane of incidence for the pictures of the study."""

import numpy as np
from matplotlib.figure import Figure

from goniosim.report.comparison import style
from goniosim.report.drawing.files import write_figure
from goniosim.report.drawing.inplane import plane_of_incidence

WIDTH, HEIGHT = 7.0, 3.4
DECADES = 3.0
# Marks along a curve: so far apart, as a share of the panel.
APART = 0.2


def curve(slices, found, theta_deg):
    """A slice along the plane of incidence.

    Parameters
    ----------
    slices : Slices
    found : Slice
    theta_deg : float
        Of the light.

    Returns
    -------
    angle : ndarray, shape (P,)
        Signed, positive on the side of the mirror direction.
    f, sigma : ndarray, shape (P, C)
    """
    m = slices.direction(theta_deg)
    return plane_of_incidence(slices.result.cells, m, theta_deg, *slices.bsdf(found, m))


def plane_figure(slices, theta_deg, channels, models, path):
    """Draw some channels of the simulation, with two standard errors, and of some models on a logarithmic scale.

    Each panel ends `DECADES` below the highest value of the simulation.

    Parameters
    ----------
    slices : Slices
    theta_deg : float
        Of the light.
    channels : dict of str to int
        One panel each.
    models : sequence of str
    path : Path
        Of the PNG file.
    """
    write_figure(path.with_suffix(""), ["png"], _draw, slices, theta_deg, channels, models)


def _draw(slices, theta_deg, channels, models):
    component = slices.material.component
    figure = Figure(figsize=(WIDTH, HEIGHT), layout="constrained")
    panels = figure.subplots(1, len(channels), squeeze=False)[0]
    for axes, (title, channel) in zip(panels, channels.items(), strict=True):
        for number, model in enumerate(models):
            angle, f, _ = curve(slices, slices.model(model, component), theta_deg)
            look = style.look(model).mark(3.5) | style.look(model).line(1.5)
            axes.plot(angle, f[:, channel], label=model, markevery=(APART * number / len(models), APART), **look)
        angle, f, sigma = curve(slices, slices.reference(component), theta_deg)
        value, error = f[:, channel], 2.0 * sigma[:, channel]
        seen = value > 0.0
        axes.fill_between(angle, np.maximum(value - error, 1e-300), value + error, where=seen, color="0.8")
        axes.plot(angle, np.where(seen, value, np.nan), "k--", label="simulation")
        _furnish(axes, title, value)
        axes.axvline(theta_deg, color="0.7", linewidth=0.8, linestyle=":")
    panels[0].set_ylabel("BSDF [1/sr]")
    panels[0].legend(frameon=False, fontsize=8)
    figure.suptitle(f"{slices.material.name}, {component}, light at {theta_deg:g}°", fontsize=9)
    return figure


def _furnish(axes, title, value):
    """Scales and labels of a panel over the signed angle of the viewer; ``value`` is the simulation."""
    highest = max(float(np.nanmax(line.get_ydata())) for line in axes.lines)
    axes.set_yscale("log")
    axes.set_ylim(10.0**-DECADES * max(value.max(initial=0.0), 1e-300), 2.0 * max(highest, 1e-300))
    axes.set_xlim(-90.0, 90.0)
    axes.set_xticks(range(-90, 91, 30))
    axes.set_xlabel("angle of the viewer [°]")
    axes.set_title(title, fontsize=9)
    axes.grid(color="0.9", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
