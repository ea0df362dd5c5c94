"""The price list as text for a person and as plain data for a program."""

from dataclasses import asdict

from ...scene import quantity
from .. import text
from .runs import ESTIMATORS


def description(made):
    """Tell a price list.

    Parameters
    ----------
    made : PriceList

    Returns
    -------
    str
    """
    directions = text.counted(len(made.scene.incident.theta_deg), "direction")
    head = [
        f"{made.scene.material.name}: what accuracy costs, {directions} on {text.counted(made.threads, 'thread')}",
        "  slice error: norm of the standard error over the norm of the slice, to be met in every direction;",
        "  times are those of all directions together, without compilation.",
    ]
    blocks = [head, *(_component_lines(name, component) for name, component in made.components.items())]
    if not made.components:
        blocks.append(["Nothing is sampled: the reflection of a single interface is integrated, without noise."])
    blocks += [_effect_lines(made), _limit_lines(made)]
    return "\n\n".join("\n".join(lines) for lines in blocks if lines)


def as_data(made):
    """Everything `description` tells, as plain data that JSON can hold.

    Parameters
    ----------
    made : PriceList

    Returns
    -------
    dict
        Times in seconds, errors and uncertainties relative.
    """
    components = {}
    for name, component in made.components.items():
        estimators = {each: [asdict(price) for price in prices] for each, prices in component.prices.items()}
        components[name] = {"estimators": estimators} | ({"models": component.models} if component.models else {})
    return {
        "components": components,
        "effects": {name: asdict(effect) for name, effect in made.effects.items()},
        "limits": {
            "subcells": made.subcells
            | {
                "models": {
                    name: [{"n": n, "error": error} for n, error in errors.items()]
                    for name, errors in made.subcells["models"].items()
                }
            },
            "cells": made.cells,
            "directions": made.directions,
            "nodes": made.nodes,
        },
    }


def _component_lines(name, component):
    if not any(component.prices.values()):
        return [f"{name}: no light that is told from noise"]
    header = ["slice error"]
    for each in ESTIMATORS:
        header += [f"{each}\ntime", "CPU\ntime", ""]
    rows = []
    for several in zip(*(component.prices[each] for each in ESTIMATORS), strict=True):
        rows.append([percent(several[0].error)])
        for price in several:
            rows[-1] += [text.duration(price.seconds), text.duration(price.cpu_seconds), how(price)]
    lines = [name, *text.table(header, rows)]
    lines += [f"  {each}: {law_text(component, each)}" for each in ESTIMATORS]
    for model, point in component.models.items():
        told = "" if point["significant"] else ", not told from noise"
        error = text.with_error(100.0 * point["error"], 100.0 * point["uncertainty"])
        lines.append(f"  {model}: {error} % in {text.duration(point['seconds'])}{told}")
    return lines


def law_text(component, estimator):
    """How error falls with time, and by what means."""
    law = component.laws[estimator]
    used = component.used[estimator]
    by = ", ".join(f"{name} ({used.count(name)} of {len(used)} directions)" for name in dict.fromkeys(used))
    slope = text.with_error(law.slope, law.slope_error, decimals=2)
    runs = f"{text.counted(law.rungs, 'run')} of {_rounded(law.fewest)} to {_rounded(law.most)} rays per direction"
    return f"error ~ t^-s, s = {slope}, from {runs}" + ("" if set(used) == {estimator} else f"; by {by}")


def _rounded(rays):
    return text.count(float(f"{rays:.2g}"))


def how(price):
    """How a price is known: ``measured``, or ``predicted``, with its uncertainty."""
    word = "measured" if price.measured else "predicted"
    return f"{word} ± {100.0 * price.uncertainty:.0f} %"


def percent(error):
    """Format a relative error: ``0.3 %``."""
    return quantity.percent(error, 3)


def _effect_lines(made):
    if not made.effects:
        return []
    rows = [
        [name, text.with_error(effect.ratio, effect.uncertainty), effect.without]
        for name, effect in made.effects.items()
    ]
    head = (
        "What effects add: time per independent path, over that of the same scene (below 1: without, paths are longer)"
    )
    return [head, *text.table(["effect", "times", "without it"], rows)]


def _limit_lines(made):
    lines = ["What limits besides noise (relative errors of a slice)"]
    models = made.subcells["models"]
    if models:
        sides = next(iter(models.values()))
        where = f"{made.subcells['component']}, {text.degrees(made.subcells['theta_deg'])} degrees"
        rows = [[name, *(percent(error) for error in errors.values())] for name, errors in models.items()]
        lines += [f"  sub-cells of a cell, for models of {where}"]
        lines += text.table(["model", *(f"{n} x {n}" for n in sides)], rows, indent="    ")
    else:
        lines.append("  sub-cells: no model applies to this material")
    for title, found, shown in (
        ("averaging over cells", made.cells, _cells),
        ("interpolation between incident directions", made.directions, _directions),
    ):
        for name, several in found.items():
            lines.append(f"  {title}, {name}: " + ", ".join(shown(each) for each in several))
    lines += [f"  nodes of the operator, {name}: {percent(bias)} at most" for name, bias in made.nodes.items()]
    return lines


def _cells(each):
    return f"{each['rows']} x {each['columns']}: {uncertain(each['lost'], each['uncertainty'])}"


def _directions(each):
    return f"{each['directions']}: {uncertain(each['error'], each['uncertainty'])}"


def uncertain(error, uncertainty):
    """A relative error with its standard error, or its upper limit where it is not told from noise."""
    upper = error + 2.0 * uncertainty
    if error <= 2.0 * uncertainty:
        return "not told from noise" if upper > 1.0 else f"< {quantity.percent(upper)}"
    return f"{text.with_error(100.0 * error, 100.0 * uncertainty)} %"
