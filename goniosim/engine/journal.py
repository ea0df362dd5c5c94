"""Decisions of a session in their order: an interrupted one goes on by those that it took before."""


class Journal:
    """What was decided, by a pilot, a clock or an error so far.

    Parameters
    ----------
    entries : list
        Decisions before an interruption, each a plain value.
    """

    def __init__(self, entries=()):
        self.entries = list(entries)
        self._next = 0

    def decide(self, take):
        """The next decision: that of before, or what ``take()`` returns."""
        if self._next == len(self.entries):
            self.entries.append(take())
        self._next += 1
        return self.entries[self._next - 1]
