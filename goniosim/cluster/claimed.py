"""One process for each task: whoever comes to one that another is at work on waits for the dead, not for the living."""

import contextlib
import os
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from goniosim.claims import SILENCE, Claim
from goniosim.errors import InUseError

_POLL_SECONDS = 2.0


@contextlib.contextmanager
def claimed(path: Path, stop: threading.Event, note: Callable[[str], object] = lambda _: None) -> Iterator[Claim]:
    """While active, no other process works on an output.

    On this machine it is known at once who lives. Of a task that was begun on another one, which a batch system has
    given up, it is known after some minutes of silence: they are waited for.

    Parameters
    ----------
    path : Path
    stop : threading.Event
        Ends the waiting.
    note : callable
        Called with a line on what is waited for.

    Raises
    ------
    OSError
        If the folder takes no new file.
    InUseError
        If another process is at work on it.
    """
    claim, end = Claim(path), time.monotonic() + SILENCE + _POLL_SECONDS
    if claim.owner is not None and claim.owner.host != os.uname().nodename:
        note(f"{path}: taken by {claim.owner}: waits until that shows no sign of life, for {SILENCE / 60:.0f} minutes")
        while claim.owner is not None and time.monotonic() < end and not stop.wait(_POLL_SECONDS):
            claim = Claim(path)
    if claim.owner is not None:
        raise InUseError(
            f"{path}: another process is at work on it ({claim.owner}); leave it to that, or stop that one first"
        )
    with claim:
        claim.remove_parts()
        yield claim
