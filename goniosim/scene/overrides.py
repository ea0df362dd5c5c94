"""Changes to a scene before it is checked: ``path=value``."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from goniosim.errors import ConfigError
from goniosim.scene.model import LIMITS
from goniosim.scene.problems import closest
from goniosim.scene.reading import read_value
from goniosim.scene.tree import Node, Origin, Path, parse_path, show, show_path

# Letters of an override that messages repeat.
SHOWN = 200


@dataclass(frozen=True)
class Override:
    """A change, and how the user asked for it.

    Attributes
    ----------
    assignment : str
        ``path=value``.
    shown : str
        What messages about it begin with, such as an option of the command line.
    """

    assignment: str
    shown: str


def override(root: Node, assignments: Iterable[str | Override]) -> Node:
    """Apply overrides to the raw content of a scene or study file.

    Parameters
    ----------
    root : Node
    assignments : iterable of str or Override
        Each ``path=value``; the value is YAML. Later ones win. A mapping that
        is absent on the way is made, and a list keeps its length. A target takes
        the place of the rays of the file, and rays that of its target and limits.

    Returns
    -------
    Node

    Raises
    ------
    ConfigError
        Not of that form, or the path leads nowhere; names all that do.
    """
    if isinstance(assignments, str | Mapping) or not isinstance(assignments, Iterable):
        form = "path=value, such as simulation.rays=1e6"
        raise ConfigError(f"overrides must be a list of {form} [got {show(assignments)}]")
    problems: list[str] = []
    asked: set[int | str] = set()
    for each in assignments:
        change = each if isinstance(each, Override) else Override(str(each), f"override {each}")
        source = change.shown if len(change.shown) <= SHOWN else change.shown[: SHOWN - 3] + "..."
        path_text, equals, value_text = change.assignment.partition("=")
        path = parse_path(path_text.strip())
        if path is None or not equals:
            problems.append(f"{source}: must be path=value, such as simulation.rays=1e6")
            continue
        origin = Origin(source, 0, path)
        try:
            value = read_value(value_text, origin) or Node(None, origin)
            root = _set(root, (), path, value)
        except ConfigError as error:
            problems += error.problems
        if path == ("simulation",):
            asked.clear()
        elif path[0] == "simulation":
            asked.add(path[1])
    if problems:
        raise ConfigError(problems)
    return _without_replaced(root, asked)


def _without_replaced(root: Node, asked: set[int | str]) -> Node:
    """Drop from the simulation what gives way to the keys that were asked for."""
    replaced = {"rays"} if "target" in asked else set()
    if "rays" in asked:
        replaced |= {"target", *LIMITS}
    simulation = root.child("simulation")
    if simulation is None or not isinstance(simulation.value, dict):
        return root
    kept = {key: child for key, child in simulation.value.items() if key not in replaced or key in asked}
    return root.with_child("simulation", replace(simulation, value=kept))


def _set(node: Node, done: Path, rest: Path, value: Node) -> Node:
    """Return a copy of the node at path `done`, in which the entry at path `rest` below it is `value`."""
    step, rest = rest[0], rest[1:]
    here = (*done, step)
    child = node.child(step)
    if isinstance(step, int):
        if not isinstance(node.value, list):
            raise _nowhere(value, f"{show_path(done)} is no list")
        if child is None:
            raise _nowhere(value, f"{show_path(done)} has {len(node.value)} entries, counted from 0")
    elif not isinstance(node.value, dict):
        raise _nowhere(value, f"{show_path(done)} has no keys")
    if not rest:
        return node.with_child(step, value)
    if child is None:
        meant = closest(step, node.value)
        if meant is not None:
            raise _nowhere(value, f"there is no {show_path(here)}", show_path((*done, meant, *rest)))
        if isinstance(rest[0], int):
            raise _nowhere(value, f"there is no {show_path(here)}")
        child = Node({}, replace(value.origin, path=here))
    return node.with_child(step, _set(child, here, rest, value))


def _nowhere(value: Node, reason: str, meant: str | None = None) -> ConfigError:
    suggestion = f" (did you mean {meant}?)" if meant else ""
    return ConfigError(f"{value.origin.source}: leads nowhere: {reason}{suggestion}")
