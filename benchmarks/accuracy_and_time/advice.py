"""Advice in plain words, with the numbers that the price lists hold."""

from goniosim.report import text

from . import tables

# What the advice is about: an error that is good enough to tell published models apart, and a study's size.
ENOUGH = 0.01
MATERIALS = 60

ADVICE = """\
## Advice

**How accurate must it be?** As accurate as the question. The best published models are off by {best} on these
materials, so a slice error of {enough} tells any of them from the truth; a smaller one only sharpens the number. Ask
for the error and not for rays:

    simulation: {{target: {{relative_error: {enough_plain}, of: slice}}, max_time: 10m}}

**How many rays do I need?** With `auto`, do not count them: a path is worth more or less with each estimator.
Independent paths need so many per direction:

{rays}

**What does a material cost me?** An error of {enough} in all {directions} directions:

{summary}

**What will a study cost me?** {materials} materials like these, as many of each kind, at {enough}: about {study} with
`auto`, and {analog} with independent paths, on this machine.

**Which knob is worth turning?** In this order:

1. The accuracy asked for. The time goes with its square, or nearly so: 3 % is up to eleven times cheaper than 1 %.
2. The estimator: leave it at `auto`. Independent paths are for checking it.
3. The number of incident directions: the time grows with it, and interpolation between them limits, see below.
4. The parametrization: `half` for highlights narrower than a cell of `classic`, which no number of rays resolves.
5. The effects of the scene. What does nothing costs nothing; three distinct channels, absorption and roughness cost
   what the table below says.
"""


def text_of(lists):
    """The advice.

    Parameters
    ----------
    lists : dict of str to PriceList

    Returns
    -------
    str
    """
    auto, analog = (_study(lists, each) for each in ("auto", "analog"))
    return ADVICE.format(
        best=_best(lists),
        enough=f"{100.0 * ENOUGH:g} %",
        enough_plain=f"{100.0 * ENOUGH:g}%",
        rays=tables.rays(lists),
        directions=len(next(iter(lists.values())).scene.incident.theta_deg),
        summary=_summary(lists),
        materials=MATERIALS,
        study=text.duration(auto),
        analog=text.duration(analog),
    )


def _summary(lists):
    rows = []
    for name, made in lists.items():
        auto, analog = (tables.price_of(made, each, ENOUGH) for each in ("auto", "analog"))
        rows.append([name, text.duration(auto.seconds), text.duration(analog.seconds)])
    return tables.table(["material", "auto", "independent paths"], rows)


def _study(lists, estimator):
    """Seconds of a study of materials like these, in equal parts."""
    return MATERIALS / len(lists) * sum(tables.price_of(made, estimator, ENOUGH).seconds for made in lists.values())


def _best(lists):
    """Range of the errors of the best model of each material."""
    best = [
        min(point["error"] for point in points.values())
        for made in lists.values()
        if (points := {n: p for n, p in tables.main_component(made)[1].models.items() if p["significant"]})
    ]
    return f"{100.0 * min(best):.2g} to {100.0 * max(best):.2g} %" if best else "some per cent"
