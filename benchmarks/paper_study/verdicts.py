"""From numbers with errors to verdicts: the rules are here and nowhere else.

A *comparison* is one inequality on one material. It is ``yes`` or ``no`` when the numbers tell it at
two standard errors, else ``open``. A *claim* is one sentence of the paper, made of comparisons. It is
reproduced if nine in ten of them are ``yes``; it cannot be told if the open ones decide about that. A
finding is reproduced if all its claims are, and not reproduced if one of them is not.
"""

import math
from dataclasses import dataclass

REPRODUCED, NOT_REPRODUCED, CANNOT_TELL = "reproduced", "not reproduced", "cannot tell"
YES, NO, OPEN = "yes", "no", "open"

SIGMAS = 2.0
SHARE = 0.9
# Two numbers are alike within a tenth of a decade, which a plot like Fig. 4 hardly shows, and close
# within a factor of two; in decades.
ALIKE, CLOSE = 0.1, math.log10(2.0)


@dataclass(frozen=True)
class Value:
    """A number with its standard error."""

    value: float
    stderr: float = 0.0


@dataclass(frozen=True)
class Claim:
    """A sentence of the paper with the answers of all comparisons that it makes.

    Attributes
    ----------
    text : str
    answers : dict of str to str
        `YES`, `NO` or `OPEN` for each comparison, by what was compared.
    """

    text: str
    answers: dict

    def count(self, answer):
        """How many comparisons ended so."""
        return list(self.answers.values()).count(answer)

    @property
    def verdict(self):
        """One of the three verdicts; a claim without comparisons cannot be told."""
        needed = SHARE * len(self.answers)
        if not self.answers:
            return CANNOT_TELL
        if self.count(YES) >= needed:
            return REPRODUCED
        return CANNOT_TELL if self.count(YES) + self.count(OPEN) >= needed else NOT_REPRODUCED


def overall(claims):
    """Verdict of a finding: the worst of its claims.

    Parameters
    ----------
    claims : iterable of Claim

    Returns
    -------
    str
    """
    verdicts = [claim.verdict for claim in claims]
    for verdict in (NOT_REPRODUCED, CANNOT_TELL):
        if verdict in verdicts:
            return verdict
    return REPRODUCED if verdicts else CANNOT_TELL


def less(a, b):
    """Whether a < b.

    The errors of a and b may come from the same noise. Their difference has at most the sum of the two
    standard errors, whatever the correlation, so that sum is what it is held against.

    Parameters
    ----------
    a, b : Value

    Returns
    -------
    str
    """
    margin = SIGMAS * (a.stderr + b.stderr)
    if b.value - a.value > margin:
        return YES
    return NO if a.value - b.value > margin or margin == 0.0 else OPEN


def within(a, b, decades):
    """Whether a and b agree within so many decades (`ALIKE`, `CLOSE`).

    Parameters
    ----------
    a, b : Value
        Positive.
    decades : float

    Returns
    -------
    str
    """
    if min(a.value, b.value) <= 0.0:
        return OPEN
    distance = abs(math.log10(a.value / b.value))
    margin = SIGMAS * (a.stderr / a.value + b.stderr / b.value) / math.log(10.0)
    if distance + margin <= decades:
        return YES
    return NO if distance - margin > decades else OPEN


def over_twice(a, b):
    """Whether a > 2 b."""
    return less(Value(2.0 * b.value, 2.0 * b.stderr), a)


def all_of(answers):
    """One answer for several that must all hold: no if one is no, open if one is open."""
    answers = list(answers)
    return NO if NO in answers else OPEN if OPEN in answers else YES
