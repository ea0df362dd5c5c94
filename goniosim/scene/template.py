"""Templates of a study: text with ``${axis}`` or ``${axis.key}`` that stands for a value of an axis."""

import re
from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

from goniosim.scene.problems import Problem, closest, listed
from goniosim.scene.tree import Node, from_plain, plain

REFERENCE = re.compile(r"\$\{([^{}]*)\}")


def variables(entries: Mapping[str, Node]) -> dict[str, Any]:
    """Name the values that one combination of axis entries offers.

    Parameters
    ----------
    entries : dict of str to Node
        For each axis the entry: a mapping, or a value by itself.

    Returns
    -------
    dict of str to object
        Plain values by ``axis`` or ``axis.key``.
    """
    named: dict[str, Any] = {}
    for axis, entry in entries.items():
        if isinstance(entry.value, dict):
            named.update({f"{axis}.{key}": plain(child) for key, child in entry.value.items()})
        else:
            named[axis] = plain(entry)
    return named


def reference_problems(node: Node, known: Collection[str]) -> list[Problem]:
    """Find references that mean nothing.

    Parameters
    ----------
    node : Node
        A template; everything below it is searched.
    known : iterable of str
        Names as from `variables`.

    Returns
    -------
    list of Problem
    """
    if isinstance(node.value, (dict, list)):
        children = node.value.values() if isinstance(node.value, dict) else node.value
        return [problem for child in children for problem in reference_problems(child, known)]
    if not isinstance(node.value, str):
        return []
    found = []
    for name in REFERENCE.findall(node.value):
        if name.strip() not in known:
            guess = closest(name.strip(), known)
            suggestion = f"${{{guess}}}" if guess else None
            offer = f"the axes offer {listed(list(known))}" if known else "only a study with `cross` has axes"
            found.append(node.problem(f"${{{name}}} is unknown; {offer}", got=False, suggestion=suggestion))
    if "${" in REFERENCE.sub("", node.value):
        found.append(node.problem("holds a ${ that is not closed: write ${axis} or ${axis.key}"))
    return found


def fill(node: Node, values: Mapping[str, Any]) -> Node:
    """Replace the references below a node.

    Parameters
    ----------
    node : Node
    values : dict of str to object
        As from `variables`; holds every name that is referred to.

    Returns
    -------
    Node
        Text that is nothing but one reference becomes the value itself, of
        whatever type; within longer text a list is joined by ``_``.
    """
    if isinstance(node.value, dict):
        return replace(node, value={key: fill(child, values) for key, child in node.value.items()})
    if isinstance(node.value, list):
        return replace(node, value=[fill(child, values) for child in node.value])
    if not isinstance(node.value, str):
        return node
    alone = REFERENCE.fullmatch(node.value.strip())
    if alone:
        return from_plain(values[alone[1].strip()], node.origin)
    return replace(node, value=REFERENCE.sub(lambda match: _text(values[match[1].strip()]), node.value))


def _text(value: object) -> str:
    if isinstance(value, list):
        return "_".join(_text(item) for item in value)
    return str(value).lower() if isinstance(value, bool) else str(value)
