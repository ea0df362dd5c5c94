"""Portions of one simulation, joined: to the same bits as if all had been one run."""

from . import assembly
from .pieces import pieces_of


class Joint:
    """Runs that portions are joined into.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    runs : list of AnalogRun or ReplicatedRun
        To which nothing was added yet.
    rays : int
        Light paths of each direction that the simulation was asked for.
    """

    def __init__(self, plan, runs, rays):
        self._plan, self._runs = plan, runs
        self._pieces = {}
        for piece in pieces_of(runs, rays):
            self._pieces.setdefault((piece.run, piece.direction), []).append(piece)
        self._next = dict.fromkeys(self._pieces, 0)
        self._seconds = dict.fromkeys(self._pieces, 0.0)

    def add(self, state):
        """Take in a portion: they come in the order of their pieces.

        Parameters
        ----------
        state : dict
            As of `portion.Portion.state`.

        Raises
        ------
        ValueError, TypeError, LookupError, AttributeError
            If it is none, or holds what is there already.
        """
        for record in state["records"]:
            key = int(record["run"]), int(record["direction"])
            number = int(record["piece"])
            if number < self._next[key]:
                raise ValueError("the same piece of work is there twice")
            self._close_gap(key, number)
            if number == 0:
                self._begin(key, record)
            else:
                self._join(key, self._pieces[key][number], record)

    def _begin(self, key, record):
        run, direction = self._runs[key[0]], key[1]
        run.restore(direction, record["sums"])
        self._seconds[key] = float(record["seconds"])
        works = int(record["works"])
        for piece in self._pieces[key]:
            if works <= 0:
                break
            works -= len(piece.works)
            self._next[key] += 1

    def _join(self, key, piece, record):
        run, direction = self._runs[key[0]], key[1]
        run.join(piece.works[: int(record["works"])], record["sums"])
        run.spending.book(direction, int(record["events"]), float(record["cpu_seconds"]))
        self._seconds[key] += float(record["seconds"])
        self._next[key] = piece.number + 1
        if _is_last(piece):
            self._note(key)

    def _close_gap(self, key, number):
        """Where pieces are missing, a round may end among them."""
        missing = self._pieces[key][self._next[key] : number]
        if any(map(_is_last, missing)):
            self._note(key)

    def _note(self, key):
        run, direction = self._runs[key[0]], key[1]
        run.finish_round(direction)
        noted = run.spending.checkpoints[direction]
        if run.rays[direction] and (not noted or noted[-1][0] != run.rays[direction]):
            errors = assembly.errors(self._plan, run, direction)
            run.spending.note(direction, run.rays[direction], self._seconds[key], errors)

    def finish(self):
        """Add up what is left open, and tell the time at each checkpoint as if one portion had followed the other."""
        for key in self._pieces:
            self._note(key)
        for run in self._runs:
            rows = run.spending.checkpoints
            most = max(map(len, rows), default=0)
            elapsed = [sum(each[min(i, len(each) - 1)][2] for each in rows if each) for i in range(most)]
            for each in rows:
                each[:] = [(row[0], row[1], elapsed[i], row[3]) for i, row in enumerate(each)]


def _is_last(piece):
    return any(work.last for work in piece.works)
