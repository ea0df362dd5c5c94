"""All runs of one simulation: which estimators, in which order, and how far."""

from dataclasses import dataclass, field
from functools import partial

import numpy as np

from . import assembly
from .analog import AnalogRun
from .drive import Drive, Limit
from .estimators import pilot
from .estimators.choose import ANALOG, AUTO, Choice, choose
from .plan import Plan
from .schedule import AUDIT_RAYS


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
    _began: float = 0.0

    @property
    def rays(self):
        """Light paths of each direction in all components."""
        return np.min([run.rays for run in self.runs], axis=0) if self.runs else np.zeros(1, int)

    @property
    def finished(self):
        """Whether everything was done that was begun."""
        return all(run.finished for run in self.runs) and not self.drive.stopped

    @property
    def reasons(self):
        """Which estimators were chosen, and why, in words."""
        return "; ".join(map(str, self.choices))

    def run(self):
        """Do all runs."""
        asked, limit = self.simulation, Limit(self.simulation.max_rays, self.simulation.max_time)
        self.choices = choose(self.plan, asked.estimator, asked.rays)
        if asked.target is not None and asked.estimator == AUTO and self.choices[0].sides:
            self._reconsider()
        self.runs = [choice.start(self.plan, asked.seed) for choice in self.choices]
        self.audit = next((run for run in self.runs if run.audits), None)
        apart = self.audit is None
        if apart:
            self.audit = AnalogRun(self.plan.in_one_cell(), asked.seed)
        audit_rays = min(asked.most_rays, AUDIT_RAYS) if apart else 0
        directions = len(self.plan.theta_deg)
        self.drive.expect(directions * (audit_rays + len(self.runs) * (asked.rays or 0)))
        if apart:
            self.audit.prepare()
            self.drive.shoot(self.audit, audit_rays)
        if asked.target is not None:
            self.reached = True
        for run in self.runs:
            self._began = self.drive.seconds
            run.prepare()
            if asked.target is None:
                self.drive.shoot(run, asked.rays, self._note)
            elif self.drive.reach(run, range(directions), partial(self._meets, asked.target), limit, self._note):
                self.reached = False

    def _reconsider(self):
        """Take the analog walk where it is through before others have begun."""
        rays, events = pilot.analog_rays(self.plan, self.simulation.seed, self.simulation.target, self.drive)
        if pilot.is_enough(self.choices, events):
            sides = tuple(sorted(side for choice in self.choices for side in choice.sides))
            self.choices = [Choice(ANALOG, sides, f"a pilot says that {rays.max():.1g} rays are enough")]

    def _note(self, run, direction):
        seconds = self.drive.seconds - self._began
        run.spending.note(direction, run.rays[direction], seconds, assembly.errors(self.plan, run, direction))

    def _meets(self, target, run, direction):
        return assembly.worst_error(self.plan, run, direction, target.of) <= target.relative_error
