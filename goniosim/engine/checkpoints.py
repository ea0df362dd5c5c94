"""When a run that goes on is kept as it stands: from time to time, and never for more than a hundredth of it."""

import time

# Share of the time that keeping may take.
MOST = 0.01


class Checkpoints:
    """To be called with a session after each piece of its work.

    Parameters
    ----------
    every : float
        Seconds from one to the next, at least.
    keep : callable
        Called with the session.
    """

    def __init__(self, every, keep):
        self._every, self._keep = every, keep
        self._due = time.monotonic() + every

    def __call__(self, session):
        """Keep what there is, if it is time to."""
        began = time.monotonic()
        if began < self._due:
            return
        self._keep(session)
        now = time.monotonic()
        self._due = now + max(self._every, (now - began) / MOST)
