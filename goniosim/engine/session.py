"""All runs of one simulation: which estimators, in which order, and how far.

An interrupted session goes on by going the same way again: what was decided is looked up in a journal, work that is
through is left out, and the sums are taken over where the next piece is due.
"""

import itertools
import threading
from dataclasses import dataclass, field

import numpy as np

from ..errors import UnusableResultError
from ..provenance import version_of
from ..scene.quantity import percent
from . import assembly
from .analog import AnalogRun
from .drive import Drive, Limit
from .estimators import pilot
from .estimators.choose import ANALOG, AUTO, Choice, choose, next_best
from .extended import MOST_OF_TARGET, Extended, gone_on
from .gain import gains, in_words
from .journal import Journal
from .outlook import Ahead, needed
from .packing import pack
from .plan import Plan
from .prior import Prior
from .rounds import FEWEST_PATHS
from .schedule import AUDIT_RAYS, LEAST_AUDIT_RAYS
from .unit import child_key

# Of `Session.state`, to be raised whenever one of before would not lead to the same bits.
VERSION = [6, version_of("goniosim")]
# Child of the seed's key, for a run that takes the place of another.
BRANCH = 5


@dataclass
class Session:
    """Runs and their outcome.

    Attributes
    ----------
    plan : goniosim.engine.plan.Plan
    simulation : goniosim.scene simulation
        What is asked for.
    drive : goniosim.engine.drive.Drive
    checkpoint : callable, optional
        Called with the session after each piece of work, when its `state` may be kept.
    has_room : callable, optional
        Tells whether there is memory for what it leaves when it is stopped.
    tell : callable, optional
        Called with an `goniosim.engine.outlook.Outlook` where a target is far.
    resumed : dict, optional
        The `state` in which a session of the same simulation was interrupted.
    prior : goniosim.engine.prior.Prior, optional
        What is there already; the session does what is missing, on random numbers of its own.
    choices : list of goniosim.engine.estimators.choose.Choice
    runs : list of AnalogRun or ReplicatedRun
        One for each choice; of different ways out.
    audit : AnalogRun
        Whose energy balance is told.
    reached : bool or None
        Whether all directions are as accurate as asked for; None without a target.
    left : bytes or None
        `state` in which it was stopped, packed.
    """

    plan: Plan
    simulation: object
    drive: Drive
    checkpoint: object = None
    resumed: dict | None = None
    prior: Prior | None = None
    choices: list = field(default_factory=list)
    runs: list = field(default_factory=list)
    audit: AnalogRun | None = None
    reached: bool | None = None
    has_room: object = None
    tell: object = None
    left: bytes | None = None
    _ready: set = field(default_factory=set)
    _spent: dict = field(default_factory=dict)
    _took: list = field(default_factory=list)
    _calls: int = 0
    _current: int = 0
    _began: float | None = None
    _from: float = 0.0
    _added: int = 0

    @property
    def known(self):
        """The runs, with what there was before them."""
        return [self._known(run) for run in self.runs]

    @property
    def rays(self):
        """Light paths of each direction in all components."""
        return np.min([run.rays for run in self.known], axis=0) if self.runs else np.zeros(1, int)

    @property
    def traced(self):
        """Whether there is anything to keep that was not there before."""
        return any(self.rays) if self.prior is None else any(any(run.rays) for run in self.runs)

    @property
    def finished(self):
        """Whether nothing is missing that was asked for, but for the limits of a target."""
        cut = self.reached is False and self.drive.stopped
        return all(run.finished for run in self.runs) and not cut

    @property
    def provenance(self):
        """Which estimators were chosen and why, and what they gained over independent paths, in words."""
        found = gains(self.plan, self.runs, self.audit) if self.audit else {}
        gained = {"estimator_gain": f"{in_words(found)} (CPU time of analog for the same noise over that of this run)"}
        before = self.prior.provenance if self.prior else {}
        return {**before, "estimator_choice": "; ".join(map(str, self.choices)), **(gained if found else {})}

    def run(self):
        """Do all runs.

        Raises
        ------
        goniosim.errors.UnusableResultError
            If it cannot go on from ``resumed``.
        goniosim.engine.extended.OtherEstimatorError
            If it cannot go on from ``prior``; nothing is done then.
        """
        try:
            self._run()
        except (ValueError, TypeError, LookupError, AttributeError, ArithmeticError) as error:
            if self.resumed is None:
                raise
            raise _misfit(error) from error
        if self.resumed is not None and not self.drive.stopped:
            raise _misfit("it was interrupted behind its end")

    def _run(self):
        asked, before = self.simulation, self.resumed or {"journal": (), "seconds": 0.0, "done": 0}
        self._journal = Journal(before["journal"])
        self.drive.go_on(before["seconds"], before["done"])
        if self.resumed is not None and before["prior"] is not None:
            self.prior = Prior(self.plan, before["prior"])
        self._choose()
        there = self._there
        least = min((int(rays.min()) for rays in there.values()), default=0)
        if asked.target is None:
            least = min(least, asked.rays)
            each = len(self.plan.theta_deg) * len(self.runs)
            if self.resumed is None:
                self.drive.go_on(0.0, each * least)
            self.drive.expect(each * asked.rays - self.drive.done)
            self._shoot(asked.rays - least)
        else:
            seconds = None if asked.max_time is None else asked.max_time - before["seconds"]
            ahead = Ahead(self._needed, self.tell or (lambda outlook: None))
            limit = Limit(asked.max_rays, seconds, self._journal, there, ahead)
            self.reached = self.drive.reach(self.runs, self._judge, self._instead, limit, self._do)
        if not self.finished and self.left is None:
            # Stopped between two pieces of work.
            self._leave()
        self.look_where_energy_goes()

    def _choose(self):
        asked = self.simulation
        self.choices = choose(self.plan, asked.estimator, asked.rays)
        if asked.target is not None and asked.estimator == AUTO and self.choices[0].sides:
            reason = self._journal.decide(self._is_easy)
            if reason is not None:
                sides = tuple(sorted(side for choice in self.choices for side in choice.sides))
                self.choices = [Choice(ANALOG, sides, reason)]
        if self.prior is not None:
            self.choices = gone_on(self.plan, self.choices, self.prior, self.simulation)
        self.runs = [choice.start(self.plan, self._key) for choice in self.choices]

    @property
    def _key(self):
        return self.simulation.seed if self.prior is None else self.prior.key(self.simulation.seed)

    @property
    def _there(self):
        """Light paths of each direction that are there before the runs, by run."""
        return {} if self.prior is None else {run: self.prior.rays(run.sides) for run in self.runs}

    def _begin(self, run):
        began = self.drive.now()
        run.prepare()
        self._ready.add(run)
        self._spent[run] = self._spent.get(run, 0.0) + self.drive.now() - began

    def _shoot(self, rays):
        """Do all runs, round by round, so that an interruption leaves something of every component."""
        if rays == 0:
            return
        rounds_of = (run.rounds(rays if run.audits else self._sensible(rays)) for run in self.runs)
        for rounds in itertools.zip_longest(*rounds_of, fillvalue=()):
            for run, works in zip(self.runs, rounds, strict=True):
                if works:
                    self._do(run, works)

    def _sensible(self, rays):
        """So many light paths, or a few more, of replicates that only go on: smaller ones say less of their scatter."""
        return max(rays, FEWEST_PATHS) if self.simulation.rays >= FEWEST_PATHS else rays

    def _do(self, run, works):
        """Do pieces of work, unless they were done before an interruption; returns the seconds they took."""
        number, before = self._calls, self.resumed
        self._calls += 1
        if before is not None and number < before["calls"]:
            self._took.append(before["took"][number])
            return self._took[-1]
        self._current = number
        since = 0.0 if before is None else self._take_over(before)
        if run not in self._ready:
            self._begin(run)
        self._began = self.drive.now() - since
        self._from = self._began - self._spent[run]
        self.drive.do(run, works, self._note, first=self._added, keep=self._keep)
        # From the very moment that checkpoints count from: none of a later call is earlier than these.
        self._took.append(self.drive.now() - self._began)
        self._spent[run] += self._took[-1]
        self._current, self._added, self._began = number + 1, 0, None
        return self._took[-1]

    def _take_over(self, state):
        """Go on from a state; returns the seconds of its last call."""
        for run, values, spent in zip(self.runs, state["runs"], state["spent"], strict=True):
            for direction, of_direction in zip(range(len(run.rays)), values, strict=True):
                run.restore(direction, of_direction)
            self._spent[run] = float(spent)
        self._added = int(state["added"])
        since = float(state["within"])
        self.resumed = None
        return since

    def _keep(self, added, stopped):
        self._added = added
        if stopped:
            self._leave()
        elif self.checkpoint is not None:
            self.checkpoint(self)

    def _leave(self):
        if self.left is None and (self.has_room is None or self.has_room()):
            self.left = pack(self.state())

    def state(self):
        """All that is needed to go on after the piece of work that was added up last, as a tree for `packing.pack`.

        Its arrays are those of the runs, which go on to change.
        """
        now = self.drive.now()
        return {
            "version": VERSION,
            "journal": self._journal.entries,
            "seconds": now,
            "done": self.drive.done,
            "calls": self._current,
            "took": self._took,
            "added": self._added,
            "within": 0.0 if self._began is None else now - self._began,
            "spent": [self._spent.get(run, 0.0) for run in self.runs],
            "choices": [[choice.estimator, choice.sides, choice.reason] for choice in self.choices],
            "runs": [[run.state(direction) for direction in range(len(run.rays))] for run in self.runs],
            "prior": None if self.prior is None else self.prior.state(),
        }

    def look_at(self, state):
        """Fill `runs` with what is known in a state, without going on.

        Parameters
        ----------
        state : dict
            As `resumed`.
        """
        self.choices = [Choice(estimator, tuple(sides), reason) for estimator, sides, reason in state["choices"]]
        self.runs = [choice.start(self.plan, self._key) for choice in self.choices]
        self.reached = None if self.simulation.target is None else False
        self._began = self.drive.now() - self._take_over(state)
        for run in self.runs:
            self._from = self._began - self._spent[run]
            for direction in range(len(self.plan.theta_deg)):
                run.finish_round(direction)
                noted = run.spending.checkpoints[direction]
                if run.rays[direction] and (not noted or noted[-1][0] != run.rays[direction]):
                    self._note(run, direction)
        self.look_where_energy_goes()

    def look_where_energy_goes(self):
        """Fill `audit`, by a short run of its own where no other tells."""
        # Shorter, if somebody waits for an end that is none yet.
        rays = AUDIT_RAYS if self.finished else LEAST_AUDIT_RAYS
        self.audit = next((run for run in self.runs if run.audits), None)
        if self.audit is None and (self.prior is None or self.prior.audit.rays.min() < rays):
            self.audit = self._audited(rays)

    def _audited(self, rays):
        """Where all energy goes, by an analog run that has no slices."""
        run = AnalogRun(self.plan.in_one_cell(), self._key)
        run.prepare()
        for works in run.rounds(min(self.simulation.most_rays, rays)):
            self.drive.do(run, works, stop=threading.Event())
        return run

    def _is_easy(self):
        """Why the analog walk is taken, where it is through before others have begun; None if it is not."""
        rays, events = pilot.analog_rays(self.plan, self.simulation.seed, self.simulation.target, self.drive)
        return f"a pilot says that {rays.max():.1g} rays are enough" if pilot.is_enough(self.choices, events) else None

    def _note(self, run, direction):
        seconds = self.drive.now() - self._from
        errors = assembly.errors(self.plan, self._known(run), direction)
        run.spending.note(direction, run.rays[direction], seconds, errors)

    def _known(self, run):
        return run if self.prior is None else Extended(run, self.prior)

    def _judge(self, run, direction):
        """Whether a direction is as accurate as asked for; None if its nodes, or too little light, will not let it."""
        return self._journal.decide(lambda: self._verdict(run, direction))

    def _verdict(self, run, direction):
        target, run = self.simulation.target, self._known(run)
        if assembly.worst_error(self.plan, run, direction, target.of) <= target.relative_error:
            return True
        is_stuck = assembly.floor(self.plan, run, direction) >= target.relative_error
        return None if is_stuck or assembly.is_too_faint(self.plan, run, direction) else False

    def _needed(self, run, direction):
        return needed(self.plan, run, self._known(run), direction, self.simulation.target)

    def _instead(self, run):
        """The next best run for what one cannot reach, because of its nodes; it has a key of its own."""
        if self.prior is not None:
            # What there is told of its nodes before.
            return None
        number, reason = self.runs.index(run), self._journal.decide(lambda: self._why_not(run))
        if reason is None:
            return None
        self.choices[number] = next_best(self.plan, run.sides, run.name, reason)
        other = self.choices[number].start(self.plan, child_key(self.simulation.seed, BRANCH))
        self.runs[number] = other
        # What it took to find out counts.
        self._spent[other] = self._spent.pop(run, 0.0)
        other.spending.take_over(run.spending)
        return other

    def _why_not(self, run):
        target = self.simulation.target
        floor = max(assembly.floor(self.plan, run, m) for m in range(len(self.plan.theta_deg)))
        if self.simulation.estimator != AUTO or floor < MOST_OF_TARGET * target.relative_error:
            return None
        return f"{run.name}: its nodes may be off by {percent(floor)}, which leaves no room in the target"


def _misfit(why):
    return UnusableResultError(f"what was left of the interrupted run does not fit the scene: {why}")
