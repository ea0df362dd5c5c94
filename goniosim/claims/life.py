"""Whether the owner of a claim lives, and the signs of life that he gives."""

import contextlib
import os
import threading
from pathlib import Path
from typing import Any

from ..cores import granted_threads
from ..errors import RefusalError
from ..owners import boot, numbering, runs

# Seconds from one sign of life to the next, and for how long there may be none. Both by the clock of the file server.
BEAT = 30.0
SILENCE = 300.0


def lives(record: dict[str, Any], free: bool | None, changed: float, home: Path) -> bool:
    """Whether an owner lives: by his process, by the lock on his claim, or by its time, whatever reaches.

    Parameters
    ----------
    record : dict
        What the claim says, if anything.
    free : bool or None
        Whether nobody holds a lock on it; None where there are no locks.
    changed : float
        Its time.
    home : Path
        The folder in which it lies.
    """
    if free is False:
        return True
    if record and record["boot"] == boot():
        if record["host"] == os.uname().nodename and record["numbering"] == numbering():
            living = runs(record["pid"], record["started"])
            if not living or record["started"]:
                return living
        if free and record["locked"]:
            return False
    # A lock may not reach from one machine to another. A clock that was set back is no sign of life either.
    now = server_time(home)
    return now is None or abs(now - changed) < SILENCE


def server_time(home: Path) -> float | None:
    """Time of the machine that keeps the files of a folder; None if it takes none."""
    import tempfile

    with contextlib.suppress(OSError), tempfile.TemporaryFile(dir=home) as probe:
        os.utime(probe.fileno())
        return os.fstat(probe.fileno()).st_mtime
    return None


def start_beating(descriptor: int, released: threading.Event) -> None:
    """Give signs of life from a thread of its own until a claim is released.

    Parameters
    ----------
    descriptor : int
        Of the claim.
    released : threading.Event
    """
    # The work comes first. Where there is no thread to spare, other machines take its owner for dead after a while.
    with contextlib.suppress(RefusalError):
        if granted_threads(2) == 2:
            own = os.dup(descriptor)
            try:
                threading.Thread(target=_beat, args=(own, released), daemon=True).start()
            except RuntimeError:
                os.close(own)


def _beat(descriptor: int, released: threading.Event) -> None:
    """Give a sign of life now and then, by the clock of the file server."""
    while not released.wait(BEAT):
        with contextlib.suppress(OSError):
            os.utime(descriptor)
    os.close(descriptor)
