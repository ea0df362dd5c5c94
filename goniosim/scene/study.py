"""Studies: one file that lists or crosses several materials."""

import itertools
import math
from dataclasses import replace

from pydantic_core import PydanticCustomError

from goniosim.scene.checking import check
from goniosim.scene.foreign import unknown_key
from goniosim.scene.model import FileName, Scene
from goniosim.scene.problems import Problem, config_error, listed
from goniosim.scene.template import fill, reference_problems, variables
from goniosim.scene.tree import Node, size

MAX_MATERIALS = 10_000
MAX_VALUES = 2_000_000
SHARED = ("incident", "slice", "simulation")


def study_scenes(root: Node) -> list[Scene]:
    """Turn the raw content of a study file into its scenes.

    Parameters
    ----------
    root : Node
        A mapping with the key ``study``.

    Returns
    -------
    list of Scene
        In the order of the list, or of the crossing with the last axis varying fastest.

    Raises
    ------
    ConfigError
        All mistakes; one that only some of the materials show names them.
    """
    problems = _form_problems(root)
    if problems:
        raise config_error(problems)
    scenes: list[Scene] = []
    clashes: list[Problem] = []
    names: dict[str, tuple[int, str]] = {}
    mistaken: dict[Problem, list[str]] = {}
    contents = _expand(root)
    for number, content in enumerate(contents):
        scene, problems = check(content)
        name = _name(content, number)
        for problem in problems:
            mistaken.setdefault(problem, []).append(name)
        first = names.setdefault(name.casefold(), (number, name))
        if first != (number, name):
            clashes.append(_same_name(content, first[1], name))
        if scene is not None:
            scenes.append(scene)
    if mistaken or clashes:
        # A mistake that every material shows lies in what they share, so it names none of them.
        shared = {problem for problem, shown in mistaken.items() if len(shown) == len(contents)}
        raise config_error(
            clashes
            + [
                problem if problem in shared else replace(problem, variants=tuple(shown))
                for problem, shown in mistaken.items()
            ]
        )
    return scenes


def _expand(root: Node) -> list[Node]:
    study = root.value["study"]
    shared = {key: root.value[key] for key in SHARED if key in root.value}
    if "materials" in study.value:
        return [Node({"material": material, **shared}, root.origin) for material in study.value["materials"].value]
    template = {"material": study.value["material"], **shared}
    axes = study.value["cross"].value
    combinations = itertools.product(*(axis.value for axis in axes.values()))
    values = [variables(dict(zip(axes, entries, strict=True))) for entries in combinations]
    return [Node({key: fill(node, each) for key, node in template.items()}, root.origin) for each in values]


def _form_problems(root: Node) -> list[Problem]:
    """Everything that can be wrong before a single material is looked at."""
    study = root.value["study"]
    problems: list[Problem] = []
    for key, node in root.value.items():
        if key == "material":
            message = "is out of place beside study: use study.material with cross, or study.materials"
            problems.append(node.problem(message, got=False))
        elif key not in ("study", *SHARED):
            problems.append(unknown_key(node, key, ("study", *SHARED), ("scene",)))
    if not isinstance(study.value, dict):
        message = "must be a mapping with name and materials, or with name, cross and material"
        return [*problems, study.problem(message)]
    crossed = "cross" in study.value or "materials" not in study.value
    keys = ("name", "cross", "material") if crossed else ("name", "materials")
    problems += [unknown_key(node, key, keys, ("study",)) for key, node in study.value.items() if key not in keys]
    missing = [key for key in keys if key not in study.value]
    message = "is missing: this key is required"
    problems += [study.problem(message, got=False, below=(key,)) for key in missing]
    if "name" in study.value:
        problems += _name_problems(study.value["name"])
    if missing:
        return problems
    if crossed:
        return problems + _cross_problems(root, study)
    return problems + _list_problems(root, study.value["materials"])


def _name_problems(node: Node) -> list[Problem]:
    try:
        FileName().check(node.value)
    except PydanticCustomError as error:
        return [node.problem(error.message())]
    return []


def _list_problems(root: Node, materials: Node) -> list[Problem]:
    if not isinstance(materials.value, list) or not materials.value:
        return [materials.problem("must be a list of materials, with at least one")]
    templates = [materials, *(root.value[key] for key in SHARED if key in root.value)]
    return [problem for node in templates for problem in reference_problems(node, ())]


def _cross_problems(root: Node, study: Node) -> list[Problem]:
    cross = study.value["cross"]
    if not isinstance(cross.value, dict) or not cross.value:
        return [cross.problem("must be a mapping from the name of an axis to the list of its entries")]
    problems = [problem for axis in cross.value.values() for problem in _axis_problems(axis)]
    if problems:
        return problems
    count = math.prod(len(axis.value) for axis in cross.value.values())
    if count > MAX_MATERIALS:
        message = f"gives {count} materials, and {MAX_MATERIALS} is the limit: shorten an axis"
        return [cross.problem(message, got=False)]
    known = variables({name: axis.value[0] for name, axis in cross.value.items()})
    templates = [study.value["material"], *(root.value[key] for key in SHARED if key in root.value)]
    # By aliases a small file may hold a large template.
    if count * sum(map(size, templates)) > MAX_VALUES:
        message = f"gives {count} materials with more than {MAX_VALUES} values in all: shorten an axis"
        return [cross.problem(message, got=False)]
    return [problem for node in templates for problem in reference_problems(node, known)]


def _axis_problems(axis: Node) -> list[Problem]:
    if not isinstance(axis.value, list) or not axis.value:
        return [axis.problem("must be a list of entries, with at least one")]
    problems = []
    first = axis.value[0]
    for entry in axis.value:
        if _keys(entry) != _keys(first):
            wanted = f"a mapping with {listed(list(first.value))}" if _keys(first) else "a value by itself"
            problems.append(entry.problem(f"must be {wanted}, as the first entry of this axis is"))
        leaves = entry.value.values() if isinstance(entry.value, dict) else [entry]
        problems += [leaf.problem("must be a number, text or a list of these") for leaf in leaves if not _is_leaf(leaf)]
    return problems


def _keys(entry: Node) -> set[str] | None:
    return set(entry.value) if isinstance(entry.value, dict) else None


def _is_leaf(node: Node) -> bool:
    if isinstance(node.value, list):
        return all(isinstance(item.value, (int, float, str)) for item in node.value)
    return isinstance(node.value, (int, float, str))


def _name(content: Node, number: int) -> str:
    name = content.value["material"].child("name")
    return name.value if name is not None and isinstance(name.value, str) else f"number {number + 1}"


def _same_name(content: Node, first: str, name: str) -> Problem:
    node = content.value["material"].value["name"]
    what = f"two materials are named {first}" if first == name else f"{first} and {name} differ only in case"
    return node.problem(f"{what}, and would share a file: give each material its own name", got=False)
