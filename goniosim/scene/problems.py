"""Mistakes in a scene file: one line each, with the place, the value and a suggestion."""

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from goniosim.errors import ConfigError


@dataclass(frozen=True)
class Problem:
    """One mistake.

    Attributes
    ----------
    source : str
        File name, or the override; empty for what Python hands over.
    line : int
        Line in that file, from 1; 0 where there are no lines.
    field : str
        Path of the value, such as ``material.layers[2].interface.alpha``;
        empty for the file as a whole.
    message : str
        What is wrong and what to do.
    got : str, optional
        The value that was found.
    suggestion : str, optional
        What was perhaps meant.
    variants : tuple of str
        Names of the materials of a study in which the mistake shows.
    """

    source: str
    line: int
    field: str
    message: str
    got: str | None = None
    suggestion: str | None = None
    variants: tuple[str, ...] = ()

    def __str__(self) -> str:
        where = f"{self.source}:{self.line}" if self.line else self.source
        text = ": ".join(filter(None, [where, self.field, self.message]))
        if self.got is not None:
            text += f" [got {self.got}]"
        if self.suggestion is not None:
            text += f" (did you mean {self.suggestion}?)"
        if self.variants:
            others = len(self.variants) - 1
            text += f" (in material {self.variants[0]}" + (f" and {others} more)" if others else ")")
        return text


def config_error(problems: Iterable[Problem]) -> ConfigError:
    """Gather mistakes into the error that reports them.

    Parameters
    ----------
    problems : list of Problem

    Returns
    -------
    ConfigError
        Its lines sorted by line of the file, overrides last, without repetition.
    """
    ordered = sorted(dict.fromkeys(problems), key=lambda problem: (problem.line == 0, problem.line))
    return ConfigError([str(problem) for problem in ordered])


def closest(word: object, known: Iterable[str]) -> str | None:
    """Return the known word that was perhaps meant, or None.

    Parameters
    ----------
    word : object
        What was written; anything but text has no close match.
    known : iterable of str
    """
    if not isinstance(word, str):
        return None
    lower = {name.lower(): name for name in known}
    match = difflib.get_close_matches(word.lower(), list(lower), n=1, cutoff=0.6)
    return lower[match[0]] if match else None


def listed(words: Sequence[str], conjunction: str = "and") -> str:
    """Join words as in a sentence: ``a, b and c``."""
    return f" {conjunction} ".join(filter(None, [", ".join(words[:-1]), words[-1]]))
