"""Runs on threads: a number of rays, or round after round until an accuracy is reached."""

import math
import threading
import time

from .ordered import in_order

# Pieces of work that wait for their turn to be added up, besides those at work.
WAITING = 2


class Drive:
    """Takes runs through their work.

    Parameters
    ----------
    threads : int
    stop : threading.Event
    progress : callable
        Called as ``progress(done_rays, total_rays)``.
    """

    def __init__(self, threads, stop, progress):
        self._threads, self._stop = threads, stop
        self._progress, self._total_rays = progress, 0
        self._done = 0
        self.seconds = 0.0
        self._started = time.perf_counter()

    @property
    def stopped(self):
        """Whether somebody asked to stop."""
        return self._stop.is_set()

    def now(self):
        """Seconds since the beginning."""
        return time.perf_counter() - self._started

    def expect(self, rays):
        """So many rays are to come, over all runs and directions, besides those that are through."""
        self._total_rays = self._done + rays

    def do(self, run, works, note=None, stop=None):
        """Do pieces of work of a run.

        Parameters
        ----------
        run : AnalogRun or ReplicatedRun
        works : list of goniosim.engine.runs.Work
        note : callable, optional
            Called as ``note(run, direction)`` at every checkpoint.
        stop : threading.Event, optional
            In the place of the drive's own.
        """
        stop = stop or self._stop
        local = threading.local()
        buffers = [run.buffer() for _ in range(min(self._threads + WAITING, len(works)))]

        def work(one, buffer):
            if stop.is_set():
                return None
            if not hasattr(local, "workspace"):
                local.workspace = run.workspace()
            return run.work(one, buffer, local.workspace, stop)

        noted = set()

        def reduce(one, outcome, buffer):
            run.reduce(one, outcome, buffer)
            if outcome is not None and not one.coarse:
                self._done += one.rays
            self.seconds = time.perf_counter() - self._started
            if one.last and not stop.is_set():
                _finish(run, one.direction, note)
                noted.add(one.direction)
            elif outcome is not None:
                noted.discard(one.direction)

        def tick():
            # From the first call on there is something to keep.
            if run.gathered:
                self._progress(self._done, max(self._total_rays, self._done))

        in_order(works, work, buffers, reduce, self._threads, stop, tick)
        for direction in sorted({one.direction for one in works} - noted):
            _finish(run, direction, note)

    def reach(self, run, directions, reached, limit, note):
        """Do rounds of a run, in each direction until it is as accurate as asked for.

        Parameters
        ----------
        run : AnalogRun or ReplicatedRun
        directions : list of int
        reached : callable
            ``reached(run, direction)``.
        limit : Limit
        note : callable
            As for `do`.

        Returns
        -------
        list of int
            Directions that were not reached.
        """
        left, number = list(directions), 0
        while left and not self._stop.is_set() and limit.allows(run, left, number):
            started = time.perf_counter()
            self.expect(len(left) * run.rays_of_round(number))
            self.do(run, run.round(number, left), note)
            limit.took(time.perf_counter() - started)
            left = [m for m in left if not reached(run, m)]
            number += 1
        return left


def _finish(run, direction, note):
    run.finish_round(direction)
    if note is not None and run.rays[direction]:
        note(run, direction)


class Limit:
    """What a run that stops at an accuracy may cost at the most.

    Parameters
    ----------
    max_rays : int or None
        Of each direction.
    max_seconds : float or None
        Of wall-clock time, from now on.
    """

    def __init__(self, max_rays, max_seconds):
        self._max_rays = math.inf if max_rays is None else max_rays
        self._end = math.inf if max_seconds is None else time.perf_counter() + max_seconds
        self._last_seconds = 0.0

    def took(self, seconds):
        """Learn how long a round took."""
        self._last_seconds = seconds

    def allows(self, run, directions, number):
        """Whether another round may be begun; the first one always may."""
        if number == 0:
            return True
        # The next round is twice as large as the last.
        return time.perf_counter() + 2.0 * self._last_seconds <= self._end and all(
            run.rays[m] + run.rays_of_round(number) <= self._max_rays for m in directions
        )
