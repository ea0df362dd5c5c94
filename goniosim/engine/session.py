"""All runs of one simulation: which estimators, in which order, and how far."""

import itertools
import threading
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from . import assembly
from .analog import AnalogRun
from .drive import Drive, Limit
from .estimators import pilot
from .estimators.choose import ANALOG, AUTO, Choice, choose
from .gain import gains, in_words
from .plan import Plan
from .schedule import AUDIT_RAYS, LEAST_AUDIT_RAYS


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
            self.reached = self.drive.reach(self.runs, partial(self._meets, asked.target), limit, self._do)
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

    def _meets(self, target, run, direction):
        return assembly.worst_error(self.plan, run, direction, target.of) <= target.relative_error
