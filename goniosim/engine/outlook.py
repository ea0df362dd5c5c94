"""What a target still takes, told while a run is under way; and when it is out of reach."""

import math
from dataclasses import dataclass

from ..accuracy import FASTEST, INDEPENDENT, fall, paths_for
from . import assembly
from .analog import AnalogRun

# Without limits, seconds from which on somebody should know before they have passed.
LONG = 3600.0
# And seconds that nobody waits for, ten years: what is told after two rounds may be off by a factor, not by that much.
HOPELESS = 3.2e8
# Limits come first if the rest takes so many times what they leave: what is told may be off by a factor.
MARGIN = 2.0
# The error of what was seen once; of what was not seen, it is no less.
SEEN_ONCE = 1.0
# It is told again once it has changed by such a factor.
NEWS = 4.0


@dataclass(frozen=True)
class Outlook:
    """How far a run is from its target.

    Attributes
    ----------
    sides : tuple of int
        Ways out that the run serves.
    error : float
        What the target is held against, in the direction that needs most; infinite if too little was seen to know it.
    paths, needed : float
        Light paths of that direction: those that are through, and what the target takes in all, or more than that if
        the error is unknown.
    seconds : float
        Of wall-clock time that all directions take from now on.
    is_cut : bool
        Whether the limits of the target come first.
    """

    sides: tuple
    error: float
    paths: int
    needed: float
    seconds: float
    is_cut: bool


def needed(plan, run, known, direction, target):
    """Light paths of a direction that a target takes in all, as far as its checkpoints tell.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    run : AnalogRun or ReplicatedRun
    known : AnalogRun or ReplicatedRun or Extended
        The same, with what there was before it.
    direction : int
    target : goniosim.scene target

    Returns
    -------
    error, paths : float
        What the target is held against, and the light paths; None for these after a single round of replicates, which
        says nothing of how their noise falls. Of an unknown error, the least that it can be.
    """
    noted = run.spending.checkpoints[direction]
    independent = isinstance(run, AnalogRun) or known is not run
    error = assembly.worst_error(plan, known, direction, target.of)
    if len(noted) < 2 and not independent:
        return error, None
    if math.isinf(error):
        slope = INDEPENDENT if independent else FASTEST
        return error, float(paths_for(target.relative_error, SEEN_ONCE, 0.0, int(known.rays[direction]), slope))
    slope = fall([row[0] for row in noted], [max(row[3].values(), default=0.0) for row in noted], independent)
    off = assembly.floor(plan, known, direction)
    return error, float(paths_for(target.relative_error, error, off, int(known.rays[direction]), slope))


class Ahead:
    """Looks ahead after each round, and says what is worth knowing.

    Parameters
    ----------
    needed : callable
        ``needed(run, direction)``, as the function of this name.
    tell : callable
        Called with an `Outlook`.
    """

    def __init__(self, needed, tell):
        self._needed, self._tell, self._told = needed, tell, {}

    def is_hopeless(self, run, paths, pace, seconds, most):
        """Whether a run will not come to its end, though nothing limits it.

        Parameters
        ----------
        run : AnalogRun or ReplicatedRun
        paths : dict of int to int
            By each direction that is not yet as accurate as asked for, its light paths.
        pace : float
            Seconds for each light path.
        seconds, most : float
            What is left of the time, and the light paths of a direction at most; infinite without limits.

        Returns
        -------
        bool
        """
        found = {m: self._needed(run, m) for m in paths}
        if any(needed is None for _, needed in found.values()):
            return False
        hardest = max(found, key=lambda m: found[m][1])
        error, total = found[hardest]
        rest = pace * sum(needed - paths[m] for m, (_, needed) in found.items())
        is_cut = rest > MARGIN * seconds or total > MARGIN * most
        is_open = math.isinf(seconds) and math.isinf(most)
        told = self._told.get(run)
        if (is_cut or (is_open and rest > LONG)) and (told is None or not told / NEWS < rest < told * NEWS):
            self._told[run] = rest
            self._tell(Outlook(run.sides, error, paths[hardest], total, rest, is_cut))
        return is_open and rest > HOPELESS
