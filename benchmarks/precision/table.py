"""Everything that is measured, as one table."""

import math
from dataclasses import dataclass

from . import cells, samplers
from .case import measure
from .functions import GROUPS, sampling
from .outcome import LIMIT, Outcome


@dataclass(frozen=True)
class Line:
    """What the page says of one number that a function returns."""

    name: str
    grid: str
    arguments: tuple[str, ...]
    sensitive: str
    outcome: Outcome


def lines(dense, say=lambda name: None):
    """A `Line` for each case, in the order of the page; ``say`` hears of each before it is measured."""
    found = []
    for case in (case for cases in GROUPS.values() for case in cases):
        say(case.name)
        found.append(Line(case.name, case.grid, case.arguments, case.sensitive, measure(case, dense)))
    for case in cells.CASES:
        say(case.name)
        found.append(Line(case.name, case.grid, case.arguments, case.sensitive, case.measure(dense)))
    return found


def deviations(dense):
    """Of the densities of both samplers from what they should be, as `samplers` finds them."""
    step = 1 if dense else 3
    numbers, turns = sampling.uniform_numbers(False)[1:], [0.03, 0.2, 0.41, 0.77]
    views, widths = [1e-16, 1e-8, 1e-3, 0.5, 0.9, 1.0 - 1e-6, 1.0][::step], [1e-6, 1e-3, 0.05, 0.3, 1.0][::step]
    return samplers.visible_normals(views, widths, numbers, turns), samplers.cosine_directions(numbers, turns)


def markdown(found):
    """The table of the page."""
    rows = [
        ("function", "grid", "points", "worst relative error", "there", "conditioning"),
        ("---", "---", "---:", "---:", "---", "---"),
        *((x.name, x.grid, str(x.outcome.points), f"{x.outcome.error:.1e}", _there(x), _condition(x)) for x in found),
    ]
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def _there(line):
    return ", ".join(f"{name} = {_number(x)}" for name, x in zip(line.arguments, line.outcome.at, strict=True))


def _number(x):
    """A few digits; of numbers next to 1, how far away they are."""
    off = x - 1.0
    if 0.0 < abs(off) < 1e-3:
        return f"1 {'+' if off > 0.0 else '−'} {abs(off):.3g}"
    return f"{x:.6g}"


def _condition(line):
    outcome = line.outcome
    if not outcome.beyond:
        return ""
    points = "1 point" if outcome.beyond == 1 else f"{outcome.beyond} points"
    there = f"condition number {outcome.condition:.1e} there" if math.isfinite(outcome.condition) else "singular there"
    return f"{line.sensitive}: {there}; {points} above {LIMIT:g}, none by more than {outcome.units:.2f} units"
