"""From the raw tree to the scene: all mistakes at once, in the user's terms."""

from typing import get_args

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from goniosim.scene.foreign import choice_meant, translate, unknown_key, value_hint
from goniosim.scene.layers import INTERFACES, Layer, Medium, Part
from goniosim.scene.model import Incident, Material, Scene, Simulation, Slice
from goniosim.scene.problems import Problem, closest, listed
from goniosim.scene.quantity import NO_NUMBER
from goniosim.scene.structure import structure_mistakes
from goniosim.scene.target import Share, Target
from goniosim.scene.tree import Node, Path, locate, plain

MAPPINGS: dict[str, type[Part]] = {
    "material": Material,
    "incident": Incident,
    "slice": Slice,
    "simulation": Simulation,
    "target": Target,
    "medium": Medium,
    **INTERFACES,
}
CHOICES: dict[str, tuple[str, ...]] = {
    "type": tuple(INTERFACES),
    "parametrization": get_args(Slice.model_fields["parametrization"].annotation),
    "estimator": get_args(Simulation.model_fields["estimator"].annotation),
    "of": get_args(Target.model_fields["of"].annotation),
}
_LAYER = list(Layer.model_fields)


def check(node: Node) -> tuple[Scene | None, list[Problem]]:
    """Turn the raw content of a scene file into a scene.

    Parameters
    ----------
    node : Node

    Returns
    -------
    Scene or None, list of Problem
        None exactly when there are problems.
    """
    node, problems = translate(node)
    problems += _structure_problems(node)
    try:
        scene = Scene.model_validate(plain(node))
    except ValidationError as error:
        problems += [_translate(node, detail) for detail in error.errors(include_url=False)]
        return None, list(dict.fromkeys(problems))
    return (None, problems) if problems else (scene, [])


def _structure_problems(node: Node) -> list[Problem]:
    # The models check the order of the layers too, but only once every single layer is sound.
    layers, rest = locate(node, ("material", "layers"))
    if rest or not isinstance(layers.value, list):
        return []
    kinds = [_kind(layer) for layer in layers.value]
    return [
        _explain(locate(layers, place)[0], ("layers", *place), message) for place, message in structure_mistakes(kinds)
    ]


def _kind(layer: Node) -> str | None:
    interface = layer.child("interface")
    if interface is not None:
        kind = interface.child("type")
        return kind.value if kind is not None and isinstance(kind.value, str) else None
    return "medium" if layer.child("medium") is not None else None


def _translate(root: Node, detail: ErrorDetails) -> Problem:
    """Word one of pydantic's errors as a Problem."""
    # Pydantic puts the kind of an interface into the path, where the file has no key of that name.
    location = detail["loc"]
    steps = zip((None, *location), location, strict=False)
    path = tuple(step for before, step in steps if not (before == "interface" and step in INTERFACES))
    node, rest = locate(root, path)
    kind = detail["type"]
    if kind == "missing":
        return node.problem("is missing: this key is required", got=False, below=rest)
    if kind == "union_tag_not_found":
        return node.problem(f"is missing: give one of {listed(CHOICES['type'], 'or')}", got=False, below=("type",))
    if kind == "extra_forbidden":
        return unknown_key(node, str(location[-1]), _known(location[:-1]))
    if kind == "literal_error":
        return _wrong_choice(node, str(path[-1]))
    if kind == "union_tag_invalid":
        return _wrong_choice(locate(node, ("type",))[0], "type")
    if kind == "tuple_type":
        return node.problem("must be a list: begin each entry with `- `")
    if kind in ("model_type", "model_attributes_type"):
        keys = _known(location)
        remedy = f": write target: {{relative_error: {_share_meant(node.value)}}}" if path[-1:] == ("target",) else ""
        return node.problem(f"must be a mapping with {listed(keys, 'or' if keys == _LAYER else 'and')}{remedy}")
    return _explain(node, path, detail["msg"])


def _explain(node: Node, path: Path, message: str) -> Problem:
    # Where a mapping belongs, a mistake in it as a whole lies in the entries that the message names.
    whole = path[-1] in MAPPINGS or path[-2:-1] == ("layers",)
    hint, suggestion = value_hint(path[-1], node.value) if message.startswith(NO_NUMBER) else ("", None)
    return node.problem(message + hint, got=not whole, suggestion=suggestion)


def _share_meant(value: object) -> str:
    return str(value) if Share().accepts(value) else "1%"


def _known(location: Path) -> list[str]:
    """Keys of the mapping at a location as pydantic gives it."""
    if not location:
        return list(Scene.model_fields)
    if isinstance(location[-1], int):
        return _LAYER
    if location[-1] == "interface":
        return ["type"]
    return list(MAPPINGS[location[-1]].model_fields)


def _wrong_choice(node: Node, key: str) -> Problem:
    choices = CHOICES[key]
    meant = choice_meant(key, node.value) or closest(node.value, choices)
    return node.problem(f"must be {listed(choices, 'or')}", suggestion=meant)
