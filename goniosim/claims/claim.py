"""The right to work on an output, and who has it."""

import contextlib
import os
import re
import threading
from collections.abc import Iterable
from pathlib import Path
from typing import Self

from .. import parts
from ..owners import short
from .life import SILENCE, start_beating
from .owner import Owner
from .taking import drop, look, remove, take

_LONGEST = 40
# With successors that died as they took over.
_CLAIM = re.compile(r"(.*\.claim)(\.[0-9a-f]{8})*", re.DOTALL)


class Claim:
    """The right to work on an output: a context manager, unless somebody else has it.

    Parameters
    ----------
    target : Path
        The output. Of a link, what it leads to.

    Attributes
    ----------
    owner : Owner or None
        Who has it; None if it is ours, until it is released.

    Raises
    ------
    OSError
        If the folder takes no new file.
    """

    def __init__(self, target: Path) -> None:
        self.owner: Owner | None = None
        self._target = Path(os.path.realpath(target))
        self._path = _place_of(target)
        self._descriptor = -1
        taken = take(self._path)
        if isinstance(taken, Owner):
            self.owner = taken
            return
        self._descriptor = taken
        self._released = threading.Event()
        start_beating(taken, self._released)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def remove_parts(self) -> None:
        """Remove parts of the output that others left behind, on whatever machine: nobody else works on it."""
        with contextlib.suppress(OSError):
            os.utime(self._descriptor)
            parts.remove_dead([self._target], before=os.fstat(self._descriptor).st_mtime - SILENCE)

    def release(self) -> None:
        """Let others have it; harmless when repeated, also by a signal handler in the midst of it."""
        if self._descriptor < 0:
            return
        remove(self._path, self._descriptor)
        descriptor, self._descriptor = self._descriptor, -1
        os.close(descriptor)
        self._released.set()


def owner_of(target: Path) -> Owner | None:
    """Who is at work on an output; None if nobody is.

    Parameters
    ----------
    target : Path

    Raises
    ------
    OSError
        If the folder cannot be read.
    """
    found = look(_place_of(target))
    return found.owner if found is not None and found.lives else None


def remove_dead(targets: Iterable[Path]) -> None:
    """Remove claims that processes on these outputs left behind when they were killed.

    Parameters
    ----------
    targets : iterable of Path
    """
    homes: dict[Path, set[str]] = {}
    for target in targets:
        place = _place_of(target)
        homes.setdefault(place.parent, set()).add(place.name)
    for home, names in homes.items():
        with contextlib.suppress(OSError):
            for entry in list(os.scandir(home)):
                match = _CLAIM.fullmatch(entry.name)
                if match and match[1] in names:
                    taken = take(Path(entry.path))
                    if not isinstance(taken, Owner):
                        drop(Path(entry.path), taken)


def _place_of(target: Path) -> Path:
    real = Path(os.path.realpath(target))
    # Names are limited, and those that are cut shall still differ.
    return real.with_name(f".{real.name[:_LONGEST]}.{short(real.name)}.claim")
