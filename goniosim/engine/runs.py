"""What all runs of an estimator share: their pieces of work, and what they have cost so far."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Work:
    """A piece of work of one incident direction.

    Attributes
    ----------
    direction : int
    number : int
        Of the work unit, or of the round.
    rays : int
        Light paths of the piece.
    replicates : range or None
        Numbers of the replicates.
    last : bool
        Whether a checkpoint of the direction follows.
    coarse : bool
        Whether only every second node is used, so that the bias of the nodes is seen.
    ends : bool
        Whether a section of sums ends with it.
    """

    direction: int
    number: int
    rays: int
    replicates: range | None = None
    last: bool = False
    coarse: bool = False
    ends: bool = False


def in_flight(waiting, threads, works):
    """Pieces of work that are begun and not yet added up, at the most.

    Parameters
    ----------
    waiting : int
        Pieces that may wait for their turn to be added up, for each thread.
    threads, works : int
    """
    return min((1 + waiting) * threads, works)


class Spending:
    """What each direction has cost, and its checkpoints.

    Parameters
    ----------
    directions : int
    """

    def __init__(self, directions):
        self.events = np.zeros(directions, np.int64)
        self.cpu_seconds = np.zeros(directions)
        self.checkpoints = [[] for _ in range(directions)]

    def share(self, cpu_seconds):
        """Book what all directions share."""
        self.cpu_seconds += cpu_seconds / len(self.cpu_seconds)

    def book(self, direction, events, cpu_seconds):
        """Book a piece of work."""
        self.events[direction] += events
        self.cpu_seconds[direction] += cpu_seconds

    def take_over(self, other):
        """Book what was spent on a run whose place this one takes."""
        self.events += other.events
        self.cpu_seconds += other.cpu_seconds

    def state(self, direction):
        """What one direction has cost, as a tree for `packing.pack`."""
        return {
            "events": self.events[direction],
            "cpu_seconds": self.cpu_seconds[direction],
            "checkpoints": self.checkpoints[direction],
        }

    def restore(self, direction, state):
        """Go on from such a tree."""
        self.events[direction] = int(state["events"])
        self.cpu_seconds[direction] = float(state["cpu_seconds"])
        self.checkpoints[direction] = [tuple(row) for row in state["checkpoints"]]

    def note(self, direction, rays, seconds, errors):
        """Note a checkpoint.

        Parameters
        ----------
        direction : int
        rays : int
        seconds : float
            Wall-clock time of the run so far.
        errors : dict of str to float
            Noise of each component, in sr^-1/2.
        """
        self.checkpoints[direction].append((rays, self.cpu_seconds[direction], seconds, errors))
