"""All runs of one simulation: which estimators, in which order, and how far."""

import itertools
import threading
from dataclasses import dataclass, field

import numpy as np

from . import assembly
from .analog import AnalogRun
from .drive import Drive, Limit
from .estimators import pilot
from .estimators.choose import ANALOG, AUTO, Choice, choose, next_best
from .gain import gains, in_words
from .plan import Plan
from .schedule import AUDIT_RAYS, LEAST_AUDIT_RAYS
from .unit import child_key

# Child of the seed's key, for a run that takes the place of another.
BRANCH = 5
# What nodes may be off by is no more than that share of a target, or the noise would have to be less than half of it.
MOST_OF_TARGET = 0.9


@dataclass
class Session:
    """Runs and their outcome.

    Attributes
    ----------
    plan : goniosim.engine.plan.Plan
    simulation : goniosim.scene simulation
        What is asked for.
    drive : goniosim.engine.drive.Drive
    choices : list of goniosim.engine.estimators.choose.Choice
    runs : list of AnalogRun or ReplicatedRun
        One for each choice; of different ways out.
    audit : AnalogRun
        Whose energy balance is told.
    reached : bool or None
        Whether all directions are as accurate as asked for; None without a target.
    """

    plan: Plan
    simulation: object
    drive: Drive
    choices: list = field(default_factory=list)
    runs: list = field(default_factory=list)
    audit: AnalogRun | None = None
    reached: bool | None = None
    _spent: dict = field(default_factory=dict)
    _from: float = 0.0

    @property
    def rays(self):
        """Light paths of each direction in all components."""
        return np.min([run.rays for run in self.runs], axis=0) if self.runs else np.zeros(1, int)

    @property
    def finished(self):
        """Whether nothing is missing that was asked for, but for the limits of a target."""
        cut = self.reached is False and self.drive.stopped
        return all(run.finished for run in self.runs) and not cut

    @property
    def provenance(self):
        """Which estimators were chosen and why, and what they gained over independent paths, in words."""
        found = gains(self.plan, self.runs, self.audit)
        gained = {"estimator_gain": f"{in_words(found)} (CPU time of analog for the same noise over that of this run)"}
        return {"estimator_choice": "; ".join(map(str, self.choices)), **(gained if found else {})}

    def run(self):
        """Do all runs."""
        asked, limit = self.simulation, Limit(self.simulation.max_rays, self.simulation.max_time)
        self.choices = choose(self.plan, asked.estimator, asked.rays)
        if asked.target is not None and asked.estimator == AUTO and self.choices[0].sides:
            self._reconsider()
        self.runs = [choice.start(self.plan, asked.seed) for choice in self.choices]
        for run in self.runs:
            self._begin(run)
        if asked.target is None:
            self.drive.expect(len(self.plan.theta_deg) * len(self.runs) * asked.rays)
            self._shoot(asked.rays)
        else:
            self.reached = self.drive.reach(self.runs, self._judge, self._instead, limit, self._do)
        self.audit = next((run for run in self.runs if run.audits), None) or self._audited()

    def _begin(self, run):
        began = self.drive.now()
        run.prepare()
        self._spent[run] = self.drive.now() - began

    def _shoot(self, rays):
        """Do all runs, round by round, so that an interruption leaves something of every component."""
        for rounds in itertools.zip_longest(*(run.rounds(rays) for run in self.runs), fillvalue=()):
            for run, works in zip(self.runs, rounds, strict=True):
                if works:
                    self._do(run, works)

    def _do(self, run, works):
        began = self.drive.now()
        self._from = began - self._spent[run]
        self.drive.do(run, works, self._note)
        self._spent[run] += self.drive.now() - began

    def _audited(self):
        """Where all energy goes, by an analog run that has no slices; short, if somebody waits for an end."""
        run = AnalogRun(self.plan.in_one_cell(), self.simulation.seed)
        run.prepare()
        rays = LEAST_AUDIT_RAYS if self.drive.stopped else AUDIT_RAYS
        for works in run.rounds(min(self.simulation.most_rays, rays)):
            self.drive.do(run, works, stop=threading.Event())
        return run

    def _reconsider(self):
        """Take the analog walk where it is through before others have begun."""
        rays, events = pilot.analog_rays(self.plan, self.simulation.seed, self.simulation.target, self.drive)
        if pilot.is_enough(self.choices, events):
            sides = tuple(sorted(side for choice in self.choices for side in choice.sides))
            self.choices = [Choice(ANALOG, sides, f"a pilot says that {rays.max():.1g} rays are enough")]

    def _note(self, run, direction):
        seconds = self.drive.now() - self._from
        run.spending.note(direction, run.rays[direction], seconds, assembly.errors(self.plan, run, direction))

    def _judge(self, run, direction):
        """Whether a direction is as accurate as asked for; None if its nodes will not let it be."""
        target = self.simulation.target
        if assembly.worst_error(self.plan, run, direction, target.of) <= target.relative_error:
            return True
        return None if assembly.floor(self.plan, run, direction) >= target.relative_error else False

    def _instead(self, run):
        """The next best run for what one cannot reach, because of its nodes; it has a key of its own."""
        target, number = self.simulation.target, self.runs.index(run)
        floor = max(assembly.floor(self.plan, run, m) for m in range(len(self.plan.theta_deg)))
        if self.simulation.estimator != AUTO or self.drive.stopped or floor < MOST_OF_TARGET * target.relative_error:
            return None
        reason = f"{run.name}: its nodes may be off by {100.0 * floor:.2g} %, which leaves no room in the target"
        self.choices[number] = next_best(self.plan, run.sides, run.name, reason)
        other = self.choices[number].start(self.plan, child_key(self.simulation.seed, BRANCH))
        self.runs[number] = other
        self._begin(other)
        # What it took to find out counts.
        self._spent[other] += self._spent.pop(run)
        other.spending.take_over(run.spending)
        return other
