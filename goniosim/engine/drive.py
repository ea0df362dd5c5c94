"""Runs on threads: a number of rays, or round after round until all are as accurate as asked for."""

import math
import threading
import time
from collections import deque

from .ordered import in_order
from .runs import in_flight


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
        buffers = [run.buffer() for _ in range(in_flight(run.waiting, self._threads, len(works)))]

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

    def reach(self, runs, judge, instead, limit, do):
        """Do rounds of all runs in turn, in each direction until it is as accurate as asked for.

        What is easy is left behind, so that the time goes to what is hard, be it a component or a direction.

        Parameters
        ----------
        runs : list of AnalogRun or ReplicatedRun
        judge : callable
            ``judge(run, direction)``: whether it is as accurate as asked for, None if it will never be.
        instead : callable
            ``instead(run)`` after the first round of a run: another one that takes its place, or None.
        limit : Limit
            Of all runs together.
        do : callable
            Called as ``do(run, works)``.

        Returns
        -------
        bool
            Whether all directions of all runs were reached.
        """
        turn, number, missed = [(run, list(range(len(run.rays)))) for run in runs], 0, False
        while turn:
            waiting, turn = deque(turn), []
            while waiting:
                run, directions = waiting.popleft()
                if self.stopped or not limit.allows(run, directions, number):
                    missed = True
                    continue
                started = self.now()
                do(run, run.round(number, directions))
                other = instead(run) if number == 0 else None
                if other is not None:
                    waiting.append((other, directions))
                    continue
                limit.took(run, self.now() - started, len(directions) * run.rays_of_round(number))
                verdicts = {m: judge(run, m) for m in directions}
                missed |= None in verdicts.values()
                if False in verdicts.values():
                    turn.append((run, [m for m in directions if verdicts[m] is False]))
            number += 1
        return not missed


def _finish(run, direction, note):
    run.finish_round(direction)
    if note is not None and run.rays[direction]:
        note(run, direction)


class Limit:
    """What a run that stops at an accuracy may cost at the most.

    Parameters
    ----------
    max_rays : int or None
        Of each direction of a run.
    max_seconds : float or None
        Of wall-clock time of all runs together, from now on.
    """

    def __init__(self, max_rays, max_seconds):
        self._max_rays = math.inf if max_rays is None else max_rays
        self._end = math.inf if max_seconds is None else time.perf_counter() + max_seconds
        self._pace = {}

    def took(self, run, seconds, paths):
        """Learn how long a round of a run took, with so many light paths in all directions."""
        self._pace[run] = seconds / paths

    def allows(self, run, directions, number):
        """Whether a run may begin another round of some directions; the first one it always may."""
        if number == 0:
            return True
        paths = run.rays_of_round(number)
        predicted = self._pace[run] * len(directions) * paths
        return time.perf_counter() + predicted <= self._end and all(
            run.rays[m] + paths <= self._max_rays for m in directions
        )
