"""The work of a simulation on a line, in pieces whose sums do not depend on where they are made."""

from dataclasses import dataclass

from .estimators.choose import choose
from .plan import make_plan


@dataclass(frozen=True)
class Piece:
    """A section of the sums of one run and incident direction.

    Attributes
    ----------
    run : int
        Number of the run.
    direction : int
    number : int
        Among those of the run and direction.
    works : tuple of goniosim.engine.runs.Work
    """

    run: int
    direction: int
    number: int
    works: tuple

    @property
    def rays(self):
        """Light paths."""
        return sum(work.rays for work in self.works if not work.coarse)


def start(plan, simulation):
    """Which estimators serve a simulation without a target, and a run of each.

    Returns
    -------
    list of goniosim.engine.estimators.choose.Choice, list of AnalogRun or ReplicatedRun
    """
    choices = choose(plan, simulation.estimator, simulation.rays)
    return choices, [choice.start(plan, simulation.seed) for choice in choices]


def pieces_of(runs, rays):
    """Hand out all work of some runs.

    Parameters
    ----------
    runs : list of AnalogRun or ReplicatedRun
    rays : int
        Light paths of each direction, or a few more.

    Returns
    -------
    list of Piece
        By run, direction and number.
    """
    return [piece for number, run in enumerate(runs) for piece in _pieces(number, run, rays)]


def piece_rays(scene):
    """Light paths of all pieces of a scene without a target, list of int."""
    return [piece.rays for piece in pieces_of(start(make_plan(scene), scene.simulation)[1], scene.simulation.rays)]


def _pieces(number, run, rays):
    groups = [[[]] for _ in run.rays]
    for works in run.rounds(rays):
        for work in works:
            sections = groups[work.direction]
            if work.coarse:
                # It goes with the first replicates, which it is held against.
                sections[0].append(work)
                continue
            if any(before.ends for before in sections[-1]):
                sections.append([])
            sections[-1].append(work)
    for direction, sections in enumerate(groups):
        for i, works in enumerate(sections):
            yield Piece(number, direction, i, tuple(works))
