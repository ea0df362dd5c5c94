"""docs/accuracy_and_time.md: advice first, then the price lists it comes from."""

from goniosim.provenance import provenance
from goniosim.report import text

from . import advice, tables

# The stacks of benchmarks/stacks that the page shows: what they are, in a few words.
CASES = {
    "plastic": "a glossy coat (α .05) over a diffuse base",
    "metal": "a rough coat (α .2) over a rough metal (α .2)",
    "slab": "a clear front (α .001) over a frosted back (α .2)",
    "narrow-slab": "narrow on narrow: clear glass (α .001 on both sides)",
}

INTRODUCTION = """\
# What accuracy costs in time

How long does a slice take, how many rays does it need, and which knob is worth turning? This page answers for four
materials, with numbers measured by `make accuracy`, which writes all of it (in {took}; {machine}, {threads}).
For a material of your own, `goniosim cost scene.yaml` prints the same and draws the same picture.

**What is measured.** The *slice error* is the norm of the standard error of a slice over the norm of the slice itself,
as in Eq. 4 of Bati et al. 2019, mean over the channels: at 1 %, a model can be told from the truth down to a relative
RMSE of about 1 %. An error counts as reached when every incident direction has it. Times are those of all {directions}
directions of a material together, direct reflection and error bars included; compilation, which happens once, is not.
`auto` is what goniosim chooses; *independent paths* are the `analog` estimator, as in most simulators. "≈" is a
prediction: the law through the runs of a ladder, continued.
"""

PRICES = """\
### {name}: {words}

{component}.

{prices}

![error against time]({picture})
"""

LAWS = """\
## How error falls with time

Independent paths have s = 1/2: ten times less error costs a hundred times more. Where `auto` has a larger s, its paths
are spread evenly on purpose, and the gain grows with the accuracy asked for.

{laws}
"""

EFFECTS = """\
## What effects cost

Time per independent path, over that of the same scene without the effect: all interfaces smooth, τ = 0, all channels
alike, a metal as the last interface. Below 1, paths are longer without: clear layers trap light that absorbing ones
end, and what a metal sends back would have left through glass. An effect that a scene does not have costs nothing, so
there is no switch for it.

{effects}
"""

LIMITS = """\
## Where something else limits

**Sub-cells.** Models are integrated over the cells of the simulation, with 5 × 5 sub-cells by default. Error of that
integration alone, of the worst model that applies:

{subcells}

**Cells.** A cell holds the mean over it. What that takes away from the norm of a slice, on these cells and on
cells twice as wide:

{cells}

**Directions.** Error of a slice that is interpolated linearly, cell by cell, in the middle between two of M incident
directions spread evenly over the range of angles:

{directions}

**Nodes.** An operator bins light at nodes half a degree apart, or less. What that may put a slice off by, as measured:

{nodes}

No number of rays mends these four. A noise far below the largest of them is worth its time only if you ask for just
these cells and just these directions.
"""

MODELS = """\
## Models beside it

The error of a model is its own, and no time makes it smaller. The {name}:

{models}
"""


def picture(name):
    """Name of a picture, without its ending."""
    return f"accuracy-{name}"


def write(lists, seconds, path):
    """Write the page.

    Parameters
    ----------
    lists : dict of str to PriceList
        By the names of `CASES`.
    seconds : float
        That measuring them took.
    path : Path
    """
    parts = [INTRODUCTION.format(**_facts(lists, seconds)), advice.text_of(lists), "## Price lists"]
    for name, made in lists.items():
        facts = {"name": name, "words": CASES[name], "picture": f"{picture(name)}.png"}
        component = tables.main_component(made)[0].capitalize()
        parts.append(PRICES.format(**facts, component=component, prices=tables.prices(made)))
    parts.append(LAWS.format(laws=tables.laws(lists)))
    parts.append(EFFECTS.format(effects=tables.effects(lists)))
    limits = {limit: getattr(tables, limit)(lists) for limit in ("subcells", "cells", "directions", "nodes")}
    parts.append(LIMITS.format(**limits))
    first = next(iter(lists))
    parts.append(MODELS.format(name=first, models=tables.models(lists[first])))
    path.write_text("\n\n".join(part.strip("\n") for part in parts) + "\n", encoding="utf-8")


def _facts(lists, seconds):
    made = next(iter(lists.values()))
    return {
        "took": text.duration(seconds),
        "machine": provenance(made.threads)["processor"],
        "threads": text.counted(made.threads, "thread"),
        "directions": len(made.scene.incident.theta_deg),
    }
