"""How much is spent on light paths, where each of them walks for long: fewer branches, and fewer paths.

What enters a smooth coat at grazing angles is little light, and sees from inside the reflectance that it saw from
outside: with a share T let in, it leaves after 1 / T rounds. An analog ray is as long inside, but only a share T of
the rays gets there. So that what a path costs stays bounded, fewer paths are followed, each of which stands for more.

Light that is caught between inner interfaces is also little, and stays for long. There the branches are what takes
the time: a coin chooses one of them, before paths become fewer.

A few paths of a pilot tell what one costs. Where they walk on and on, their weights tell when they will end. If that
is out of sight, light is caught for good: what is inside after the rounds that the analog walk grants is lost, as
there, and its energy balance tells how much that is.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..layout import WEIGHT
from ..rounds import SMALLEST
from ..unit import BATCH, pilot_key
from .layout import EVENTS, STAGES
from .lobes import FEWER_LATER

# Batches in the fullest queue, above which inner interfaces do not branch. From there on no event adds
# rays, so that this, and what `unit.queue_capacity` says of such traffic, is all that a queue must hold.
CROWD = 3
# Rounds through the stack, of two events at every interface, that a path may take without becoming one of fewer.
ROUNDS = 32
# Paths of the pilot, its events between two looks at them, and stages after which it ends.
_PATHS = 64
_LOOK = 1 << 12
_STAGES = 1 << 16
# Times what a path is granted, above which its end is out of sight: the smallest replicate could not afford one of
# them by far, which is a second or so. Light that enters at 89.9999 degrees stays a seventh of it.
_OUT_OF_SIGHT = 16 * SMALLEST


@dataclass(frozen=True)
class Effort:
    """What is spent on the light paths of every direction.

    Attributes
    ----------
    crowds : ndarray of int64, shape (M,)
        Rays in the fullest queue, above which an inner interface does not branch: `CROWD` batches, or -1.
    followed : ndarray, shape (M,)
        Share of the paths that are followed, in (0, 1]; 1 where paths are short.
    patience : ndarray, shape (M,)
        How many times the rounds of the analog walk it takes until what is still inside is lost.
    """

    crowds: np.ndarray
    followed: np.ndarray
    patience: np.ndarray

    @classmethod
    def unbounded(cls, directions):
        """Every path and every branch, but in a crowd."""
        return cls(np.full(directions, CROWD * BATCH), np.ones(directions), np.ones(directions))


def find_effort(plan, workspace):
    """What paths are worth that may be long.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    workspace : goniosim.engine.splitting.workspace.Workspace
        Knows facets and roulette; its effort is unbounded.

    Returns
    -------
    Effort
    """
    effort = Effort.unbounded(len(plan.theta_deg))
    for direction, facets in enumerate(workspace.facets):
        affordable = _PATHS * ROUNDS * (2 * len(plan.kinds) + facets.sum() / FEWER_LATER)
        branches = len(plan.kinds) > 2
        pilot = _Pilot(plan, workspace, direction, effort.crowds[direction])
        if branches and not pilot.ends_before(affordable):
            effort.crowds[direction] = -1
            pilot = _Pilot(plan, workspace, direction, -1)
        if pilot.ends_before(affordable):
            continue
        pilot.ends_before(math.inf)
        events = pilot.expected()
        if events > _OUT_OF_SIGHT * affordable:
            effort.followed[direction] = max(affordable / pilot.events, 1.0 / _PATHS)
        else:
            effort.followed[direction] = affordable / events
            effort.patience[direction] = events / affordable
    return effort


class _Pilot:
    """A few paths, followed as far as need be."""

    def __init__(self, plan, workspace, direction, crowd):
        self._plan, self._workspace = plan, workspace
        self._step = direction, pilot_key(direction), _LOOK, crowd
        self._ended = False
        # Events so far, and the light that was inside, at every look.
        self._seen = []
        workspace.begin(_PATHS)

    @property
    def events(self):
        return int(self._workspace.state[EVENTS])

    def ends_before(self, events):
        """Go on until all paths have ended, so many events are over, or too many stages."""
        workspace = self._workspace
        while not self._ended and self.events <= events and workspace.state[STAGES] <= _STAGES:
            self._ended = workspace.advance(*self._step)
            self._seen.append((self.events, self._light_inside()))
        return self._ended and self.events <= events

    def _light_inside(self):
        """Sum of the largest weights of all rays that wait."""
        weights = self._workspace.queues[:, WEIGHT : WEIGHT + self._plan.n_distinct]
        filled = self._workspace.filled
        return sum(float(each[:, :n].max(axis=0).sum()) for each, n in zip(weights, filled, strict=True))

    def expected(self):
        """Events until all is over, by how light has decayed between the middle and the end of what was seen."""
        if self._ended:
            return self.events
        (middle, light_then), (events, light) = self._seen[len(self._seen) // 2], self._seen[-1]
        decay = math.log(max(light_then / light, 1.0)) / (events - middle) if light > 0.0 else 0.0
        # Roulette begins when a tenth of the light is left, and then takes as many rays as there is light lost.
        return events + (1.0 + math.log(10.0)) / max(decay, 1e-300)
