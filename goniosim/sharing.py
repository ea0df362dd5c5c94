"""Work on several outputs, shared among the processes that come by: each takes what nobody has claimed."""

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Generic, TypeVar

from .claims import Claim, Owner
from .writing import explained

Item = TypeVar("Item")


class Sharing(Generic[Item]):
    """What is to be done, to be iterated over once.

    Parameters
    ----------
    items : sequence
    path_of : callable
        The output of an item.
    is_done : callable
        Called with an item that nobody else works on, and whether its output is still as it was: whether it holds by
        now what is asked for.

    Attributes
    ----------
    finished : list
        Items that others finished in the meantime.
    owners : list of (item, Owner)
        Items that others are at work on.
    """

    def __init__(
        self, items: Sequence[Item], path_of: Callable[[Item], Path], is_done: Callable[[Item, bool], bool]
    ) -> None:
        self._items = list(items)
        self._path_of = path_of
        self._is_done = is_done
        self._before = {path_of(item): _stamp(path_of(item)) for item in self._items}
        self.finished: list[Item] = []
        self.owners: list[tuple[Item, Owner]] = []

    def __iter__(self) -> Iterator[tuple[int, Item, Claim]]:
        """Yield what is to be done: its number, from 1, and itself, with the claim on it, which is to be released.

        What others have claimed is looked at again at the end, since they may have died.

        Raises
        ------
        OutputError
            If a folder takes no new file.
        """
        todo, took = list(enumerate(self._items, 1)), True
        while todo and took:
            took, self.owners, left = False, [], []
            for number, item in todo:
                with explained(self._path_of(item)):
                    claim = Claim(self._path_of(item))
                if claim.owner is not None:
                    self.owners.append((item, claim.owner))
                    left.append((number, item))
                elif self._is_to_do(item, claim):
                    took = True
                    yield number, item, claim
            todo = left

    def is_untouched(self, item: Item) -> bool:
        """Whether the output of an item is as it was in the beginning."""
        path = self._path_of(item)
        return _stamp(path) == self._before[path]

    def _is_to_do(self, item: Item, claim: Claim) -> bool:
        try:
            claim.remove_parts()
            done = self._is_done(item, self.is_untouched(item))
        except BaseException:
            claim.release()
            raise
        if done:
            claim.release()
            self.finished.append(item)
        return not done


def _stamp(path: Path) -> tuple[int, int, int] | None:
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_ino, found.st_size, found.st_mtime_ns
