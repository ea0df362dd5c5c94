"""The mutants: small changes of the source, each of which makes some number wrong.

Tables ``[[mutant]]`` of the files ``*.toml`` beside this one, with

``name``
    Of its own, over all files.
``breaks``
    What is wrong then, in one sentence.
``file``, ``old``, ``new``
    A text that stands in the file just once, and what takes its place.
``tests``
    Tests that have to catch it, as pytest takes them: as narrow and as fast as possible.
``sizes``
    Optional. How large the bug is: each takes the place of ``SIZE`` in ``new``. The first has to be caught, and stands
    for ``SIZE`` in ``breaks``; those after it are smaller and smaller, and are tried until one is not seen.
``unit``
    What a size is, if it is no factor.
"""

import tomllib
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PLACEHOLDER = "SIZE"


@dataclass(frozen=True)
class Mutant:
    """See above."""

    room: str
    name: str
    breaks: str
    file: str
    old: str
    new: str
    tests: tuple
    sizes: tuple = ()
    unit: str = "factor"

    @property
    def sentence(self):
        """What is wrong, with the size that has to be caught."""
        return self.breaks.replace(PLACEHOLDER, in_words(self.sizes[0])) if self.sizes else self.breaks

    def is_meant_by(self, pattern):
        """Whether its name, perhaps with its room, matches a pattern."""
        return any(fnmatchcase(name, pattern) for name in (self.name, f"{self.room}/{self.name}"))

    def applied(self, source, size=None):
        """The source with the bug; a ValueError if it has no place there, or more than one."""
        places = source.count(self.old)
        if places != 1:
            raise ValueError(f"{self.name}: its text stands {places} times in {self.file}, and not once")
        new = self.new if size is None else self.new.replace(PLACEHOLDER, repr(size))
        return source.replace(self.old, new)


def catalogue(only=()):
    """All mutants, by rooms; or those whose names match a pattern, as ``name`` or ``room/name``."""
    found = []
    for path in sorted(Path(__file__).parent.glob("*.toml")):
        for table in tomllib.loads(path.read_text())["mutant"]:
            lists = {name: tuple(table.pop(name, ())) for name in ("tests", "sizes")}
            found.append(Mutant(path.stem, **table, **lists))
    return [mutant for mutant in found if not only or any(map(mutant.is_meant_by, only))]


def in_words(size):
    """A size for people: ``0.5``, ``1.02``, ``1 + 1e-08``."""
    step = size - 1.0
    return f"1 {'+' if step > 0.0 else '-'} {abs(step):.0e}" if 0.0 < abs(step) < 2e-4 else f"{size:g}"
