"""The tables of the page, from price lists."""

from goniosim.report import text
from goniosim.report.cost.prices import ERRORS
from goniosim.report.cost.runs import ESTIMATORS
from goniosim.report.cost.summary import percent, uncertain

from ..paper_study.markdown import table

# The component that is looked at: internal paths, or for slabs what they transmit.
MAIN = ("transmission", "reflection/internal")


def main_component(made):
    """Name and `goniosim.report.cost.price_list.Component` of what a material is about."""
    name = next(name for name in MAIN if name in made.components)
    return name, made.components[name]


def price_of(made, estimator, error):
    """The `goniosim.report.cost.prices.Price` of an error of the main component."""
    return next(each for each in main_component(made)[1].prices[estimator] if each.error == error)


def prices(made):
    """Seconds and how they are known, by error and estimator; how much sooner ``auto`` is there."""
    rows = []
    for error in ERRORS:
        auto, analog = (price_of(made, each, error) for each in ESTIMATORS)
        gain = analog.cpu_seconds / auto.cpu_seconds
        rows.append([percent(error), *map(_shown, (auto, analog)), f"{gain:.3g}"])
    return table(["slice error", "auto", "independent paths", "times less CPU time"], rows)


def _shown(price):
    sign = "" if price.measured else "≈ "
    return f"{sign}{text.duration(price.seconds)} ± {100.0 * price.uncertainty:.0f} %"


def laws(lists):
    """Slopes, and by what means, of all materials."""
    rows = []
    for name, made in lists.items():
        component = main_component(made)[1]
        law, used = component.laws["auto"], component.used["auto"]
        by = ", ".join(f"{each} ({used.count(each)})" for each in dict.fromkeys(used))
        rows.append([name, by, text.with_error(law.slope, law.slope_error, 2)])
    return table(["material", "estimator (directions)", "s in error ~ t^-s"], rows)


def rays(lists):
    """How many independent paths per direction an error takes in the worst direction."""
    rows = []
    for name, made in lists.items():
        law = main_component(made)[1].laws["analog"]
        rows.append([name, *(_count(max(law.rays(error)[0])) for error in ERRORS)])
    return table(["independent paths", *map(percent, ERRORS)], rows)


def _count(rays):
    return text.count(float(f"{rays:.1g}"))


def effects(lists):
    """What each effect adds to the time of a path."""
    names = dict.fromkeys(effect for made in lists.values() for effect in made.effects)
    rows = [[name, *(_ratio(made.effects.get(name)) for made in lists.values())] for name in names]
    return table(["effect", *lists], rows)


def _ratio(effect):
    return "" if effect is None else text.with_error(effect.ratio, effect.uncertainty)


def subcells(lists):
    """The worst of the models by the number of sub-cells."""
    rows = []
    for name, made in lists.items():
        models = made.subcells["models"]
        if models:
            sides = next(iter(models.values()))
            rows.append([name, *(percent(max(errors[n] for errors in models.values())) for n in sides)])
    return table(["worst model", *(f"{n} × {n}" for n in sides)], rows)


def cells(lists):
    """What averaging over cells takes away."""
    return _limits(lists, "cells", lambda each: f"{each['rows']} × {each['columns']}", "lost")


def directions(lists):
    """What is lost between incident directions."""
    return _limits(lists, "directions", lambda each: f"M = {each['directions']}", "error")


def nodes(lists):
    """What the nodes of an operator may be off by."""
    rows = []
    for name, made in lists.items():
        bias = made.nodes.get(main_component(made)[0])
        rows.append([name, "no nodes" if bias is None else f"< {percent(bias)}"])
    return table(["material", "bias of the slice"], rows)


def _limits(lists, limit, heading, key):
    rows, header = [], []
    for name, made in lists.items():
        found = getattr(made, limit).get(main_component(made)[0])
        if found:
            header = [heading(each) for each in found]
            rows.append([name, *(uncertain(each[key], each["uncertainty"]) for each in found)])
    return table(["material", *header], rows)


def models(made):
    """Errors and times of the models, the best first."""
    points = main_component(made)[1].models
    rows = [
        [name, _model_error(point), text.duration(point["seconds"])]
        for name, point in sorted(points.items(), key=lambda item: item[1]["error"])
    ]
    return table(["model", "error", "time of all directions"], rows) if rows else "No model applies."


def _model_error(point):
    return uncertain(point["error"], point["uncertainty"]) if point["significant"] else "not told from noise"
