"""A portion of the work of one simulation: some of its pieces, to be joined with the others elsewhere.

What a direction is begun with is added up as in a plain run; what lies behind pieces of somebody else is kept section
by section.
"""

import time

from . import assembly
from .packing import amount
from .pieces import pieces_of, start
from .session import VERSION


class Portion:
    """Sums of some of the pieces of a simulation.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    simulation : goniosim.scene simulation
        Without a target.
    first, stop : int
        Numbers of its pieces among `pieces.pieces_of` all runs: from ``first`` to before ``stop``.

    Attributes
    ----------
    runs : list of AnalogRun or ReplicatedRun
    done : int
        Pieces of work that are added up.
    total_rays : int
        Light paths of all.
    """

    def __init__(self, plan, simulation, first, stop):
        self._plan, self._range = plan, (first, stop)
        _, self.runs = start(plan, simulation)
        self._pieces = pieces_of(self.runs, simulation.rays)[first:stop]
        begun = {(piece.run, piece.direction) for piece in self._pieces if piece.number == 0}
        self._works = [
            (piece, work, (piece.run, piece.direction) in begun) for piece in self._pieces for work in piece.works
        ]
        self._apart, self._cost = {}, {}
        self.done = self._through = 0
        self.total_rays = sum(piece.rays for piece in self._pieces)
        self._since = time.perf_counter()

    @property
    def finished(self):
        """Whether all pieces are added up."""
        return self.done == len(self._works)

    @property
    def rays(self):
        """Light paths that are added up; never all before the last piece of work, which may have none of its own."""
        return self._through if self.finished else min(self._through, self.total_rays - 1)

    @property
    def noise(self):
        """Largest noise of a slice in the directions that it has begun, in sr^-1/2, as of their last finished round.

        None if no round is finished. What others have of these directions makes it smaller.
        """
        last = [noted[-1][3] for run in self.runs for noted in run.spending.checkpoints if noted]
        return max((error for errors in last for error in errors.values()), default=None)

    def run(self, drive, keep=None):
        """Do what is left.

        Parameters
        ----------
        drive : goniosim.engine.drive.Drive
        keep : callable, optional
            Called with the portion after each piece of work.
        """
        drive.go_on(0.0, self.rays)
        drive.expect(self.total_rays - self.rays)
        for number, run in enumerate(self.runs):
            works = [work for piece, work, _ in self._works[self.done :] if piece.run == number]
            if works and not drive.stopped:
                self._since, before = time.perf_counter(), run.spending.cpu_seconds.copy()
                run.prepare()
                # Booked with the first piece of work, and not with directions that are not here.
                self._cost[number] = float((run.spending.cpu_seconds - before).sum())
                run.spending.cpu_seconds[:] = before
                drive.do(_Share(self, run), works, keep=None if keep is None else lambda added, stopped: keep(self))

    def reduce(self, run, work, report, buffer):
        """Add up the next piece of work."""
        began = time.thread_time()
        piece, _, begun = self._works[self.done]
        cpu_seconds = self._cost.pop(piece.run, 0.0)
        now = time.perf_counter()
        seconds, self._since = now - self._since, now
        self.done += 1
        self._through += 0 if work.coarse else work.rays
        key = (piece.run, piece.direction, 0 if begun else piece.number)
        record = self._apart.setdefault(key, {"works": 0, "events": 0, "cpu_seconds": 0.0, "seconds": 0.0})
        record["works"] += 1
        record["seconds"] += seconds
        if begun:
            run.spending.book(work.direction, 0, cpu_seconds)
            run.reduce(work, report, buffer)
            if work.last:
                run.finish_round(work.direction)
                errors = assembly.errors(self._plan, run, work.direction)
                run.spending.note(work.direction, run.rays[work.direction], record["seconds"], errors)
            return
        if "sums" not in record:
            record["sums"] = run.apart()
        run.reduce_apart(record["sums"], work, report, buffer)
        record["events"] += report.events
        record["cpu_seconds"] += report.cpu_seconds + cpu_seconds + time.thread_time() - began

    def state(self):
        """All that was added up, as a tree for `packing.pack`; its arrays go on to change."""
        records = []
        for (number, direction, piece), record in self._apart.items():
            sums = record["sums"].state() if "sums" in record else self.runs[number].state(direction)
            records.append({**record, "run": number, "direction": direction, "piece": piece, "sums": sums})
        return {"version": VERSION, "pieces": list(self._range), "done": self.done, "records": records}

    def restore(self, state):
        """Go on from such a tree.

        Raises
        ------
        ValueError, TypeError, LookupError, AttributeError, ArithmeticError
            If it is none of this portion.
        """
        if list(state["pieces"]) != list(self._range):
            raise ValueError("not the state of this run: it is of other pieces of work")
        done = int(state["done"])
        if not 0 < done <= len(self._works):
            raise ValueError(f"not the state of this run: {done} pieces of work where there are {len(self._works)}")
        through = {}
        for piece, work, begun in self._works[:done]:
            key = piece.run, piece.direction, 0 if begun else piece.number
            through.setdefault(key, (begun, []))[1].append(work)
        for record in state["records"]:
            number, direction, piece = (int(record[name]) for name in ("run", "direction", "piece"))
            begun, works = through.pop((number, direction, piece))
            held = {name: amount(record[name]) for name in ("cpu_seconds", "seconds")}
            held |= {name: int(amount(record[name])) for name in ("works", "events")}
            if held["works"] != len(works):
                raise ValueError("not the state of this run: numbers of pieces that contradict each other")
            if begun:
                self.runs[number].restore(direction, record["sums"])
                self.runs[number].require(direction, works)
            else:
                held["sums"] = self.runs[number].apart()
                held["sums"].restore(record["sums"])
                self.runs[number].require_apart(held["sums"], works)
            self._apart[number, direction, piece] = held
        if through:
            raise ValueError("not the state of this run: pieces of work are missing")
        self.done = done
        self._through = sum(work.rays for _, work, _ in self._works[: self.done] if not work.coarse)


class _Share:
    """A run as `drive.Drive` knows it, whose work is added up in a portion."""

    def __init__(self, portion, run):
        self._portion, self._run = portion, run
        self.waiting, self.rays = run.waiting, [0] * len(run.rays)
        self.buffer, self.workspace, self.work = run.buffer, run.workspace, run.work

    @property
    def gathered(self):
        return self._portion.done > 0

    def reduce(self, work, report, buffer):
        self._portion.reduce(self._run, work, report, buffer)

    def finish_round(self, direction):
        """The portion sees to that, where a round is its own."""
