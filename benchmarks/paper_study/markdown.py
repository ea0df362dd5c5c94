"""Tables and numbers in Markdown."""

import math

from goniosim.report.text import with_error

from .verdicts import NO, OPEN, YES


def number(found):
    """A `Value` as ``0.0447 ± 0.0002``; four digits where there is no error or hardly any."""
    if found.value == 0.0:
        return "0"
    if found.stderr < 1e-4 * abs(found.value):
        return f"{found.value:.4g}"
    if math.isinf(found.stderr) or math.isnan(found.value):
        return "n/a"
    if abs(found.value) >= 10.0 and found.stderr >= 10.0:
        return f"{found.value:.0f} ± {found.stderr:.0f}"
    return with_error(found.value, found.stderr)


def table(header, rows):
    """A table; the first column is aligned to the left, all others to the right.

    Parameters
    ----------
    header : sequence of str
    rows : sequence of sequences
        Cells are written with ``str``.

    Returns
    -------
    str
        Without a line feed at its end.
    """
    lines = [_line(header), "|---|" + "---:|" * (len(header) - 1)]
    return "\n".join([*lines, *(_line(row) for row in rows)])


def claims_table(claims):
    """What was compared, and how often it came out which way."""
    rows = [[claim.text, claim.count(YES), claim.count(NO), claim.count(OPEN), claim.verdict] for claim in claims]
    return table(["claim", "yes", "no", "open", "so"], rows)


def failing(claim, most=6):
    """Names of the comparisons of a claim that are not ``yes``, in one line."""
    names = [f"{name} ({answer})" for name, answer in claim.answers.items() if answer != YES]
    rest = len(names) - most
    return ", ".join(names[:most]) + (f" and {rest} more" if rest > 0 else "")


def _line(cells):
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"
