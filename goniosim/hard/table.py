"""The table of hard cases: as text, as JSON, and as Markdown."""

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import Any

from ..report.text import counted, duration, table
from .catalogue import Case
from .check import Check
from .running import Outcome

TITLE = "# Hard cases"
HEADER = ("checked", "expected", "got", "deviation", "verdict")
# One long message would push everything aside. Of what is cut the end stays: which of how many it is.
WIDEST, END = 60, 24


def listing(cases: Iterable[Case]) -> str:
    """Lay out names and titles by topic."""
    lines: list[str] = []
    for topic, group in groupby(cases, key=lambda case: case.topic):
        members = list(group)
        width = max(len(case.name) for case in members)
        lines += [*([""] if lines else []), topic, *(f"  {case.name.ljust(width)}   {case.title}" for case in members)]
    return "\n".join(lines)


def names(cases: Iterable[Case]) -> list[dict[str, str]]:
    """Return name, topic and title of each case, for JSON."""
    return [{"name": case.name, "topic": case.topic, "title": case.title} for case in cases]


def case_text(outcome: Outcome) -> str:
    """Lay out what became of one case."""
    rows = [tuple(_short(text) for text in _cells(check)) for check in outcome.checks]
    head = f"{outcome.case.name}   {outcome.case.title} ({duration(outcome.seconds)})"
    return "\n".join([head, *table(HEADER, rows)]) + "\n"


def verdict(outcomes: Sequence[Outcome]) -> str:
    """Sum up in one sentence, the same on every machine, and name the cases that fail."""
    checks = [check for outcome in outcomes for check in outcome.checks]
    what = f"{counted(len(outcomes), 'case')}, {counted(len(checks), 'check')}"
    failed = [outcome.case.name for outcome in outcomes if not outcome.holds]
    if not failed:
        return f"{what}: all hold"
    many = counted(sum(not check.holds for check in checks), "check")
    return f"{what}: {many} failed, in {counted(len(failed), 'case')}: {', '.join(failed)}"


def rows(outcomes: Iterable[Outcome]) -> list[dict[str, Any]]:
    """Return a mapping for each check, for JSON."""
    return [
        {
            "case": outcome.case.name,
            "title": outcome.case.title,
            # Of the whole case.
            "seconds": round(outcome.seconds, 3),
            "checked": check.checked,
            "expected": check.expected,
            "got": check.got,
            # What has no number in JSON is told by the verdict.
            "deviation": check.deviation if check.deviation is not None and check.deviation < 1e300 else None,
            "unit": check.unit,
            "limit": check.limit,
            "verdict": _verdict(check),
        }
        for outcome in outcomes
        for check in outcome.checks
    ]


def markdown(outcomes: Sequence[Outcome]) -> str:
    """Write the page of the documentation."""
    lines = [
        TITLE,
        "",
        "Scenes at the edges of what can be described, each held against what is exactly known of it. Written by",
        "`goniosim hard -o docs/hard_cases.md`, which checks the same on any machine; `goniosim hard NAME` checks one.",
        "The scenes stand in `configs/hard`. Where several numbers are compared, the table tells the one that is",
        "furthest off. A right number is more than 6 standard errors off in 2e-9 of all seeds if it is normally",
        "distributed, in 1e-6 if its error comes from 32 replicates; seeds are fixed.",
        "",
        "*Exact adding* tells where light goes in a stack of smooth interfaces, put together one by one from below, in",
        "closed form. *Sums over its slopes* tell it of a rough interface: by Gauss's rule, over facets of all slopes.",
        "The *audit* of a simulation books all light that arrives: as reflected, transmitted, absorbed or lost.",
        "",
        "Beyond these cases: [every function against 40 digits](precision.md); random legal scenes held to laws",
        "(`tests/laws`: 100 in `make test`, 2280 in `make test-all`); random numbers in the orders in which",
        "walks draw them (`tests/hard/test_random_*.py`); interiors of rough dielectrics cell by cell",
        "(`tests/statistical/test_interiors.py`); and [deliberate bugs](mutants.md), which tests have to catch.",
        "",
        f"{verdict(outcomes)}.",
    ]
    for topic, group in groupby(outcomes, key=lambda outcome: outcome.case.topic):
        lines += ["", f"## {topic}"]
        for outcome in group:
            lines += ["", f"### {outcome.case.name}", "", f"{outcome.case.title} {outcome.case.why}", ""]
            lines += [_line(HEADER), _line("---" for _ in HEADER)]
            lines += [_line(_cells(check)) for check in outcome.checks]
    return "\n".join(lines) + "\n"


def _cells(check: Check) -> tuple[str, str, str, str, str]:
    far = "" if check.deviation is None else f"{check.deviation:.2g} {check.unit} of {check.limit:g}"
    return check.checked, check.expected, check.got, far, _verdict(check)


def _verdict(check: Check) -> str:
    return "holds" if check.holds else "fails"


def _short(text: str) -> str:
    return text if len(text) <= WIDEST else f"{text[: WIDEST - END - 3]}...{text[-END:]}"


def _line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
