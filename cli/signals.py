"""Signals and time limits: the first asks the simulation to stop and keep what it has, a second Ctrl-C ends it at once.

Batch systems send SIGTERM before they end a job, SIGXCPU at a limit, and whatever they were told to send as a warning.
"""

import contextlib
import os
import signal
import threading
import time

from .policy import say_error

# `timeout` and some batch systems deliver one signal twice: to the process and to its group.
SAME_SIGNAL = 0.3

NAMES = {signal.SIGINT: "Ctrl-C", signal.SIGTERM: "SIGTERM", signal.SIGHUP: "SIGHUP"}
# What stops a simulation besides.
WARNINGS = {signal.SIGUSR1: "SIGUSR1", signal.SIGUSR2: "SIGUSR2", signal.SIGXCPU: "SIGXCPU"}
# "Run me again": what is missing is traced then.
UNFINISHED = 75


def _handle_all(handler, names=NAMES):
    """Set one handler for all signals, and return those before; ``nohup`` remains what it promises."""
    earlier = {signum: signal.getsignal(signum) for signum in names}
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


def told_to_stop_early():
    """From now on a signal to stop ends the command at once: there is nothing to keep yet, and it is to be run again.

    Returns
    -------
    callable
        Puts everything back.
    """

    def end(signum, frame):
        with contextlib.suppress(OSError):
            os.write(2, f"goniosim: stopped by {(NAMES | WARNINGS)[signum]} before the first rays\n".encode())
        os._exit(UNFINISHED)

    earlier = _handle_all(end, {signum: name for signum, name in (NAMES | WARNINGS).items() if signum != signal.SIGINT})

    def put_back():
        for signum, handler in earlier.items():
            signal.signal(signum, handler)

    return put_back


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
    """While active, turns signals and the end of the time into a request to stop.

    Parameters
    ----------
    time_limit : float, optional
        Seconds until the simulation is to stop.

    Attributes
    ----------
    event : threading.Event
        Set by the first signal, if something worth keeping is being gathered.
    gathering : bool
        Whether it is; until then the first signal ends the process at once.
    reservation : goniosim.store.Reservation or None
    claim : goniosim.claims.Claim or None
        To be released before the process ends at once.
    reason : str or None
        What the user calls the first signal, or the end of the time.
    exit_code : int
        130 after Ctrl-C, as a shell reports it; `UNFINISHED` after anything else.
    """

    def __init__(self, time_limit=None):
        self.event = threading.Event()
        self.gathering = False
        self.reservation = None
        self.claim = None
        self.reason = None
        self.exit_code = UNFINISHED
        self._since = 0.0
        self._timer = None if time_limit is None else threading.Timer(time_limit, self._ask, ("the time limit",))

    def __enter__(self):
        self._earlier = _handle_all(self._handle, NAMES | WARNINGS)
        if self._timer is not None:
            self._timer.daemon = True
            self._timer.start()
        return self

    def __exit__(self, *_):
        if self._timer is not None:
            self._timer.cancel()
        for signum, handler in self._earlier.items():
            signal.signal(signum, handler)

    def _handle(self, signum, frame):
        now = time.monotonic()
        if self.reason is None:
            if signum == signal.SIGINT:
                self.exit_code = 128 + signum
            self._ask((NAMES | WARNINGS)[signum])
        elif signum == signal.SIGINT and now - self._since > SAME_SIGNAL:
            self._end("at once: what was gathered since the last checkpoint is not kept")

    def _ask(self, reason):
        if self.reason is None:
            self.reason = reason
            self._since = time.monotonic()
            if not self.gathering:
                self._end("before the first rays")
            self.event.set()

    def _end(self, when):
        # No exception: the compiler's threads would hold it up, and a destructor might swallow it.
        for held in (self.reservation, self.claim):
            if held is not None:
                held.release()
        with contextlib.suppress(OSError):
            os.write(2, f"\ngoniosim: stopped by {self.reason} {when}\n".encode())
        os._exit(self.exit_code)
