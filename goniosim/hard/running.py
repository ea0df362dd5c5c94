"""Cases one after the other, whatever happens in one of them."""

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from .catalogue import Case
from .check import Check, statement, whether


@dataclass(frozen=True)
class Outcome:
    """What became of a case.

    Attributes
    ----------
    case : Case
    checks : tuple of Check
        Those made before an error, and one that tells it, if there was one; one that fails, if there were none.
    seconds : float
    """

    case: Case
    checks: tuple[Check, ...]
    seconds: float

    @property
    def holds(self) -> bool:
        """Whether all of it holds."""
        return all(check.holds for check in self.checks)


def run(cases: Iterable[Case]) -> Iterator[Outcome]:
    """Check cases.

    Parameters
    ----------
    cases : iterable of Case

    Yields
    ------
    Outcome
        As soon as it is known. An error in a case is one of its checks that fails, and the next case goes on.
    """
    for case in cases:
        began = time.perf_counter()
        made: list[Check] = []
        try:
            made.extend(case.checks(case.scene))
        except Exception as error:
            message = " ".join(f"{type(error).__name__}: {error}".split())
            made.append(statement("runs to its end", False, "no error", message))
        if not made:
            made.append(whether("something is checked", True, False))
        yield Outcome(case, tuple(made), time.perf_counter() - began)
