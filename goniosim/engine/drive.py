"""Runs on threads: a number of rays, or round after round until all are as accurate as asked for."""

import math
import threading
import time
from collections import deque

import numpy as np

from .journal import Journal
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

    Attributes
    ----------
    done : int
        Light paths that are through.
    """

    def __init__(self, threads, stop, progress):
        self._threads, self._stop = threads, stop
        self._progress, self._total_rays = progress, 0
        self.done = 0
        self._started = time.perf_counter()

    @property
    def stopped(self):
        """Whether somebody asked to stop."""
        return self._stop.is_set()

    def now(self):
        """Seconds since the beginning, with those before an interruption."""
        return time.perf_counter() - self._started

    def go_on(self, seconds, done):
        """Count time and light paths from where an interrupted run has been."""
        self._started -= seconds
        self.done += done

    def expect(self, rays):
        """So many rays are to come, over all runs and directions, besides those that are through."""
        self._total_rays = self.done + rays

    def do(self, run, works, note=None, stop=None, first=0, keep=None):
        """Do pieces of work of a run; once stopped, none is added up behind one that was given up.

        Parameters
        ----------
        run : AnalogRun or ReplicatedRun
        works : list of goniosim.engine.runs.Work
        note : callable, optional
            Called as ``note(run, direction)`` at every checkpoint.
        stop : threading.Event, optional
            In the place of the drive's own.
        first : int
            Pieces that were added up before an interruption.
        keep : callable, optional
            Called as ``keep(number, stopped)`` after each piece, with how many are added up: what they add up to may
            be kept then. After a stop, once.

        Returns
        -------
        float
            Seconds that it took.
        """
        began = self.now()
        stop = stop or self._stop
        left = works[first:]
        local = threading.local()
        buffers = [run.buffer() for _ in range(in_flight(run.waiting, self._threads, len(left)))]

        def work(one, buffer):
            if stop.is_set():
                return None
            if not hasattr(local, "workspace"):
                local.workspace = run.workspace()
            return run.work(one, buffer, local.workspace, stop)

        noted = set()
        for one in works[:first]:
            _remember(noted, one)
        added, given_up = first, False

        def reduce(one, outcome, buffer):
            nonlocal added, given_up
            given_up |= outcome is None
            if given_up:
                return
            run.reduce(one, outcome, buffer)
            added += 1
            if not one.coarse:
                self.done += one.rays
            _remember(noted, one)
            if one.last:
                _finish(run, one.direction, note)
            if keep is not None and not stop.is_set():
                keep(added, False)

        def tick():
            # From the first call on there is something to keep.
            if run.gathered:
                self._progress(self.done, max(self._total_rays, self.done))

        in_order(left, work, buffers, reduce, self._threads, stop, tick)
        if keep is not None and stop.is_set():
            keep(added, True)
        for direction in sorted({one.direction for one in works} - noted):
            _finish(run, direction, note)
        return self.now() - began

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
            Called as ``do(run, works)``; returns the seconds that it took.

        Returns
        -------
        bool
            Whether all directions of all runs were reached.
        """
        turn, number, missed = [(run, list(range(len(run.rays)))) for run in runs], 0, False
        if limit.begun:
            turn, missed = _judged(turn, judge)
        while turn:
            waiting, turn = deque(turn), []
            while waiting:
                run, directions = waiting.popleft()
                if self.stopped or not limit.allows(run, directions, number):
                    missed = True
                    continue
                seconds = do(run, run.round(number, directions))
                if self.stopped:
                    missed = True
                    continue
                other = instead(run) if number == 0 else None
                if other is not None:
                    waiting.append((other, directions))
                    continue
                limit.took(run, seconds, len(directions) * run.rays_of_round(number))
                left, hopeless = _judged([(run, directions)], judge)
                missed |= hopeless
                turn += left
            number += 1
        return not missed


def _judged(turn, judge):
    """Directions of each run that are not yet as accurate as asked for, and whether some will never be."""
    verdicts = [(run, {m: judge(run, m) for m in directions}) for run, directions in turn]
    left = [(run, [m for m, verdict in found.items() if verdict is False]) for run, found in verdicts]
    return [each for each in left if each[1]], any(None in found.values() for _, found in verdicts)


def _remember(noted, one):
    """A piece of work with a checkpoint behind it, or one that asks for another."""
    if one.last:
        noted.add(one.direction)
    else:
        noted.discard(one.direction)


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
    journal : Journal, optional
    begun : dict of object to ndarray, shape (M,), optional
        By run, light paths of each direction that are there before it.
    ahead : goniosim.engine.outlook.Ahead, optional
        Who tells what the accuracy still takes.
    """

    def __init__(self, max_rays, max_seconds, journal=None, begun=None, ahead=None):
        self._journal, self._ahead = journal or Journal(), ahead
        self.begun = begun or {}
        self._max_rays = math.inf if max_rays is None else max_rays
        self._end = math.inf if max_seconds is None else time.perf_counter() + max_seconds
        self._pace = {}

    def took(self, run, seconds, paths):
        """Learn how long a round of a run took, with so many light paths in all directions."""
        self._pace[run] = seconds / paths

    def allows(self, run, directions, number):
        """Whether a run may begin another round of some directions; the first of all it always may."""
        return (number == 0 and not self.begun) or self._journal.decide(
            lambda: self._leave_room(run, directions, number)
        )

    def _leave_room(self, run, directions, number):
        paths, now = run.rays_of_round(number), time.perf_counter()
        # Of a run that only goes on, nobody has seen a round yet.
        pace = self._pace.get(run, 0.0)
        there = self.begun.get(run, np.zeros(len(run.rays), int))
        held = {m: int(there[m]) + int(run.rays[m]) for m in directions}
        look = None if self._ahead is None or pace == 0.0 else self._ahead.is_hopeless
        if look and look(run, held, pace, self._end - now, self._max_rays):
            return False
        return now + pace * len(directions) * paths <= self._end and all(
            rays + paths <= self._max_rays for rays in held.values()
        )
