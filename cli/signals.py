"""Ctrl-C, SIGTERM and a closed terminal: the first asks the simulation to stop, a second Ctrl-C ends it at once."""

import contextlib
import os
import signal
import threading
import time

from .policy import say_error

# `timeout` and some batch systems deliver one signal twice: to the process and to its group.
SAME_SIGNAL = 0.3

NAMES = {signal.SIGINT: "Ctrl-C", signal.SIGTERM: "SIGTERM", signal.SIGHUP: "SIGHUP"}


def _handle_all(handler):
    """Set one handler for all signals, and return those before; ``nohup`` remains what it promises."""
    earlier = {signum: signal.getsignal(signum) for signum in NAMES}
    if earlier[signal.SIGHUP] is signal.SIG_IGN:
        del earlier[signal.SIGHUP]
    for signum in earlier:
        signal.signal(signum, handler)
    return earlier


@contextlib.contextmanager
def tidied_up():
    """While active, SIGTERM and SIGHUP end the command as an exception does: nothing unfinished stays behind."""

    def end(signum, frame):
        say_error(f"stopped by {NAMES[signum]}")
        raise SystemExit(128 + signum)

    interrupt = signal.getsignal(signal.SIGINT)
    earlier = _handle_all(end)
    signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        for signum, handler in earlier.items():
            signal.signal(signum, handler)


@contextlib.contextmanager
def undisturbed():
    """Let signals wait until some files have been moved: moments."""
    waiting = []
    earlier = _handle_all(lambda signum, _: waiting.append(signum))
    try:
        yield
    finally:
        for signum, handler in earlier.items():
            signal.signal(signum, handler)
        for signum in waiting[:1]:
            signal.raise_signal(signum)


class StopSignals:
    """While active, turns signals into a request to stop.

    Attributes
    ----------
    event : threading.Event
        Set by the first signal, if something worth keeping is being gathered.
    gathering : bool
        Whether it is; until then the first signal ends the process at once.
    reservation : goniosim.store.Reservation or None
        To be released before the process ends at once.
    signum : signal.Signals or None
        The first signal.
    """

    def __init__(self):
        self.event = threading.Event()
        self.gathering = False
        self.reservation = None
        self.signum = None

    def __enter__(self):
        self._earlier = _handle_all(self._handle)
        return self

    def __exit__(self, *_):
        for signum, handler in self._earlier.items():
            signal.signal(signum, handler)

    @property
    def name(self):
        """What the user calls the first signal."""
        return NAMES[self.signum]

    @property
    def exit_code(self):
        """128 and the number of the first signal, as a shell reports it."""
        return 128 + self.signum

    def _handle(self, signum, frame):
        now = time.monotonic()
        if self.signum is None:
            self.signum = signal.Signals(signum)
            self._since = now
            if not self.gathering:
                self._end("before the first rays")
            self.event.set()
        elif signum == signal.SIGINT and now - self._since > SAME_SIGNAL:
            self._end("at once: the rays gathered are not kept")

    def _end(self, when):
        # No exception: the compiler's threads would hold it up, and a destructor might swallow it.
        if self.reservation is not None:
            self.reservation.release()
        with contextlib.suppress(OSError):
            os.write(2, f"\ngoniosim: stopped by {self.name} {when}\n".encode())
        os._exit(self.exit_code)
