"""The raw content of a scene file, in which every value knows where it was written."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from goniosim.scene.problems import Problem

MAX_DEPTH = 50

Path = tuple[int | str, ...]


@dataclass(frozen=True)
class Origin:
    """Where a value was written.

    Attributes
    ----------
    source : str
        File name, or the override; empty for what Python hands over.
    line : int
        Line in that file, from 1; 0 where there are no lines.
    path : tuple of str and int
        Keys and indices that lead to the value in what the user wrote.
    worked_out : str
        The key under which the value belongs, if it is not the one that was written but follows from it.
    """

    source: str
    line: int
    path: Path = ()
    worked_out: str = ""


@dataclass(frozen=True)
class Node:
    """A value, and where it was written.

    Attributes
    ----------
    value : dict of str to Node, list of Node, or a plain scalar
    origin : Origin
    """

    value: Any
    origin: Origin

    def child(self, step: int | str) -> "Node | None":
        """Return the Node at a key or an index, or None where there is none."""
        if isinstance(step, str):
            return self.value.get(step) if isinstance(self.value, dict) else None
        inside = isinstance(self.value, list) and 0 <= step < len(self.value)
        return self.value[step] if inside else None

    def with_child(self, step: int | str, child: "Node") -> "Node":
        """Return a copy in which the entry at a key or an index is `child`."""
        if isinstance(step, str):
            return replace(self, value={**self.value, step: child})
        return replace(self, value=[*self.value[:step], child, *self.value[step + 1 :]])

    def problem(self, message: str, got: bool = True, suggestion: str | None = None, below: Path = ()) -> Problem:
        """Describe a mistake in this value.

        Parameters
        ----------
        message : str
        got : bool
            Whether to show the value.
        suggestion : str, optional
            What the user may have meant.
        below : tuple
            Path from this value to an entry that should be there.

        Returns
        -------
        Problem
        """
        path = show_path(self.origin.path + tuple(below))
        shown = show(plain(self)) if got else None
        if shown is not None and self.origin.worked_out:
            shown = f"{self.origin.worked_out}: {shown}"
        return Problem(self.origin.source, self.origin.line, path, message, shown, suggestion)


def plain(node: Node) -> Any:
    """Return the value without positions, as dicts, lists and scalars."""
    if isinstance(node.value, dict):
        return {key: plain(child) for key, child in node.value.items()}
    if isinstance(node.value, list):
        return [plain(child) for child in node.value]
    return node.value


def size(node: Node) -> int:
    """Number of values in a node, itself included."""
    if isinstance(node.value, (dict, list)):
        children = node.value.values() if isinstance(node.value, dict) else node.value
        return 1 + sum(map(size, children))
    return 1


def from_plain(value: object, origin: Origin) -> Node:
    """Wrap mappings, sequences and scalars that come without positions.

    Parameters
    ----------
    value : object
        Arrays and numbers of numpy are as good as lists and plain numbers.
    origin : Origin
        Where the whole was written; entries share all but its path.

    Returns
    -------
    Node

    Raises
    ------
    RecursionError
        Nested deeper than `MAX_DEPTH`.
    """
    if len(origin.path) > MAX_DEPTH:
        raise RecursionError
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return Node({str(key): from_plain(item, _below(origin, str(key))) for key, item in value.items()}, origin)
    if isinstance(value, Sequence) and not isinstance(value, (str, bytes)):
        return Node([from_plain(item, _below(origin, index)) for index, item in enumerate(value)], origin)
    return Node(value, origin)


def locate(node: Node, path: Path) -> tuple[Node, Path]:
    """Follow a path as far as it goes.

    Parameters
    ----------
    node : Node
    path : tuple of str and int

    Returns
    -------
    Node, tuple
        The deepest entry that exists, and the rest of the path.
    """
    for done, step in enumerate(path):
        child = node.child(step)
        if child is None:
            return node, tuple(path[done:])
        node = child
    return node, ()


def show_path(path: Path) -> str:
    """Write a path as a user would: ``material.layers[2].interface``."""
    text = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path)
    return text.lstrip(".")


def parse_path(text: str) -> Path | None:
    """Read a path such as ``material.layers[2].interface``.

    Returns
    -------
    tuple of str and int, or None
        None where the text is not a path.
    """
    if not re.fullmatch(r"[\w-]+(\[\d{1,9}\])*(\.[\w-]+(\[\d{1,9}\])*)*", text):
        return None
    steps = re.findall(r"([\w-]+)|\[(\d+)\]", text)
    return tuple(key if key else int(index) for key, index in steps)


def show(value: object, width: int = 60) -> str:
    """Write a value as it stands in a file, on one short line."""
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, (list, tuple)):
        text = "[" + ", ".join(show(item, width) for item in value[:width]) + "]"
    elif value is None:
        return "nothing"
    elif isinstance(value, bool):
        return str(value).lower()
    elif isinstance(value, int) and value.bit_length() > 4 * width:
        return f"a number of more than {width} digits"
    else:
        text = repr(value)
    return text if len(text) <= width else text[: width - 3] + "..."


def _below(origin: Origin, step: int | str) -> Origin:
    return replace(origin, path=(*origin.path, step))
