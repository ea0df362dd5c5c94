"""Ctrl-C in Python: the first asks the simulation to stop, a second one ends it at once."""

import signal
import threading
from types import FrameType
from typing import Self


class Stop(threading.Event):
    """A request to stop, by Ctrl-C or by somebody else's event; a context manager.

    While active it takes Ctrl-C in the main thread, the only one in which Python lets it; a handler of
    the user's own is called as well, and is back in place afterwards.

    Parameters
    ----------
    event : threading.Event, optional
        Asks to stop as well; it is looked at, never set.

    Attributes
    ----------
    gathering : bool
        Whether there may be something worth keeping; without, the first Ctrl-C raises at once.
    interrupted : bool
        Whether Ctrl-C was pressed.
    """

    def __init__(self, event: threading.Event | None = None) -> None:
        super().__init__()
        self.gathering = False
        self.interrupted = False
        self._event = event

    def is_set(self) -> bool:
        """Whether somebody asked."""
        return self.interrupted or super().is_set() or (self._event is not None and self._event.is_set())

    def __enter__(self) -> Self:
        self._earlier = signal.getsignal(signal.SIGINT)
        # Where Ctrl-C is ignored, or kills, somebody wants it so.
        self._taken = threading.current_thread() is threading.main_thread() and callable(self._earlier)
        if self._taken:
            signal.signal(signal.SIGINT, self._handle)
        return self

    def __exit__(self, *_: object) -> None:
        if self._taken:
            signal.signal(signal.SIGINT, self._earlier)

    def _handle(self, signum: int, frame: FrameType | None) -> None:
        # Not `set`, which takes a lock that the interrupted code may hold.
        again, self.interrupted = self.interrupted, True
        if callable(self._earlier) and self._earlier is not signal.default_int_handler:
            self._earlier(signum, frame)
        if again or not self.gathering:
            raise KeyboardInterrupt
