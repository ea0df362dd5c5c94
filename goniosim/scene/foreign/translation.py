"""A scene in the words of other tools is read as it was meant, so that all that is wrong with it is found at once."""

import re
from dataclasses import replace

from goniosim.scene.foreign import values
from goniosim.scene.foreign.words import ESTIMATORS, INDICES, OF, PARAMETRIZATIONS, TYPES, Meaning, meaning, normal
from goniosim.scene.layers import INTERFACES, Layer, Medium, Part
from goniosim.scene.model import Incident, Material, Scene, Simulation, Slice
from goniosim.scene.problems import Problem, closest, listed
from goniosim.scene.quantity import Checked, looks_numeric
from goniosim.scene.target import Target
from goniosim.scene.tree import Node, from_plain, plain, show

# Stand-ins for what cannot be told, so that nothing else is said about it. They never get into a scene.
_SOUND = {
    "eta": 1.5,
    "kappa": 1.0,
    "alpha": 0.1,
    "rho": 0.5,
    "tau": 0.0,
    "theta_deg": [0.0],
    "target": {"relative_error": 0.01},
}
_SOUND_INTERFACE = {"type": "dielectric", "eta": 1.5}

_DIGITS = re.compile(r"\d+(e[+-]?\d+)?", re.IGNORECASE)
_TYPES = {normal(word): (why, kind) for kind, why, words in TYPES for word in words.split()}
_CHOICES = {
    key: {normal(word): choice for choice, words in table.items() for word in words.split()}
    for key, table in (("parametrization", PARAMETRIZATIONS), ("estimator", ESTIMATORS), ("of", OF))
}
_SECTIONS: dict[str, type[Part]] = {
    "material": Material,
    "incident": Incident,
    "slice": Slice,
    "simulation": Simulation,
}
_PARTS: dict[str, type[Part]] = {**_SECTIONS, "target": Target, "medium": Medium, **INTERFACES}


def translate(root: Node) -> tuple[Node, list[Problem]]:
    """Replace the words of other tools in the raw content of a scene.

    Parameters
    ----------
    root : Node

    Returns
    -------
    Node
        In the words of goniosim, as far as their meaning is known.
    list of Problem
        One for each word that was replaced.
    """
    translator = _Translator()
    return translator.scene(root), translator.problems


def unknown_key(node: Node, key: str, known: list[str] | tuple[str, ...], places: tuple[str, ...] = ()) -> Problem:
    """Describe a key that does not exist, by its meaning elsewhere or else by its spelling.

    Parameters
    ----------
    node : Node
        The value under that key.
    key : str
    known : sequence of str
        The keys that exist there.
    places : tuple of str
        Where to look the word up, see `goniosim.scene.foreign.words.KEYS`.

    Returns
    -------
    Problem
    """
    found = meaning(key, places)
    if found is None:
        return node.problem(f"unknown key; the keys here are {listed(known)}", False, closest(key, known))
    return node.problem(found.message, got=False, suggestion=found.key)


def value_hint(key: object, value: object) -> tuple[str, str | None]:
    """What to add about a value that is no number where one should be.

    Parameters
    ----------
    key : str or int
        The key that it stands under.
    value : object

    Returns
    -------
    str
        Addition to the message, perhaps empty.
    str or None
        What was perhaps meant.
    """
    if key == "alpha" and isinstance(value, list):
        return "; roughness that differs between directions is not available", None
    if key == "eta" and isinstance(value, list):
        return "; an index for each channel is not available in a dielectric", None
    if key not in ("eta", "kappa") or not isinstance(value, str) or looks_numeric(value):
        return "", None
    number = r"(\d+\.?\d*|\.\d+)"
    if parts := re.fullmatch(rf"{number}\s*[+-]\s*(?:{number}\s*\*?\s*[ij]|[ij]\s*\*?\s*{number})", value.strip()):
        return "; an index has two keys here", f"eta: {parts[1]} and kappa: {parts[2] or parts[3]}"
    known = INDICES.get(normal(value)) if key == "eta" else None
    if known is not None:
        return "; no materials are known by name", f"{known:g}"
    return "; no materials are known by name, so look up the index for red, green and blue", None


def choice_meant(key: str, value: object) -> str | None:
    """The choice that a word of another tool stands for, or None."""
    return _CHOICES.get(key, {}).get(normal(value)) if isinstance(value, str) else None


class _Translator:
    def __init__(self) -> None:
        self.problems: list[Problem] = []

    def scene(self, root: Node) -> Node:
        root = self._keys(root, list(Scene.model_fields), "scene")
        for key, part in _SECTIONS.items():
            child = root.child(key)
            if child is not None:
                root = root.with_child(key, self._keys(child, list(part.model_fields), key))
        simulation = root.child("simulation")
        target = simulation.child("target") if simulation else None
        if simulation is not None and target is not None:
            target = self._keys(target, list(Target.model_fields), "target")
            root = root.with_child("simulation", simulation.with_child("target", target))
        material = root.child("material")
        layers = material.child("layers") if material else None
        if material is None or layers is None or not isinstance(layers.value, list):
            return root
        layers = replace(layers, value=[self._layer(layer) for layer in layers.value])
        return root.with_child("material", material.with_child("layers", layers))

    def _layer(self, written: Node) -> Node:
        node = self._keys(written, list(Layer.model_fields), "layer")
        if written.value and node.value == {}:
            return from_plain({"interface": _SOUND_INTERFACE}, written.origin)
        medium, interface = node.child("medium"), node.child("interface")
        if medium is not None:
            node = node.with_child("medium", self._keys(medium, list(Medium.model_fields), "medium"))
        if interface is not None:
            node = node.with_child("interface", self._interface(interface))
        return node

    def _interface(self, node: Node) -> Node:
        node = self._keys(node, ["type"], "type") if node.child("type") is None else node
        written = node.child("type")
        if written is not None and isinstance(written.value, str) and written.value not in INTERFACES:
            why, kind = _TYPES.get(normal(written.value), ("", ""))
            if why:
                message = f"must be {listed(tuple(INTERFACES), 'or')}; {why}"
                self.problems.append(written.problem(message, suggestion=kind))
                if kind is None:
                    return from_plain(_SOUND_INTERFACE, node.origin)
                node = node.with_child("type", replace(written, value=kind))
        chosen = node.child("type")
        kinds = [name for name in INTERFACES if chosen is not None and chosen.value == name] or list(INTERFACES)
        known = [key for name in kinds for key in INTERFACES[name].model_fields]
        return self._keys(node, known, *kinds, "interface")

    def _keys(self, node: Node, known: list[str], *places: str) -> Node:
        """Replace the keys of one mapping."""
        if not isinstance(node.value, dict):
            return node
        node = self._rejoined(node)
        kept: dict[str, Node] = {}
        for key, child in node.value.items():
            found = None if key in known else meaning(key, places)
            if found is None:
                kept[key] = child
                continue
            siblings = {normal(key): plain(child) for key, child in node.value.items()}
            meant = self._meant(child, found, siblings, places)
            if found.key is not None and found.key not in (*node.value, *kept):
                kept[found.key] = meant
        return replace(node, value=kept)

    def _meant(self, child: Node, found: Meaning, siblings: dict[str, object], places: tuple[str, ...]) -> Node:
        """Note the problem of a foreign key, and give the value it should have under our key."""
        value = found.value(plain(child), siblings) if found.key else None
        suggestion, origin = found.key, child.origin
        if found.key and _is_numeric(value):
            origin = replace(origin, worked_out=found.key)
            if _is_sound(value, found.key, places):
                suggestion = f"{found.key}: {_shown(value)}"
        self.problems.append(child.problem(found.message, got=False, suggestion=suggestion))
        if found.value is values.unchanged:
            return child
        return from_plain(_SOUND[found.key or ""] if value is None else value, origin)

    def _rejoined(self, node: Node) -> Node:
        """Mend ``{eta: 1,5, ...}``, which YAML reads as ``eta: 1`` and a key ``5`` without a value."""
        kept: dict[str, Node] = {}
        before = None
        for key, child in node.value.items():
            whole = kept[before].value if before is not None else None
            if child.value is None and _DIGITS.fullmatch(key) and type(whole) is int and 0 <= whole < 10**15:
                number = f"{whole}.{key}"
                message = f"a comma separates entries here: write {before}: {number}, with a decimal point"
                self.problems.append(child.problem(message, got=False))
                kept[before] = replace(kept[before], value=float(number))
                before = None
            else:
                kept[key] = child
                before = key
        return replace(node, value=kept)


def _is_sound(value: object, key: str, places: tuple[str, ...]) -> bool:
    """Whether a value may stand under a key at one of some places, as far as it alone decides that."""
    fields = [_PARTS[place].model_fields for place in places if place in _PARTS]
    checks = [each for field in fields if key in field for each in field[key].metadata if isinstance(each, Checked)]
    return not checks or any(check.accepts(value) for check in checks)


def _is_numeric(value: object) -> bool:
    if isinstance(value, list):
        return all(_is_numeric(item) for item in value)
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _shown(value: object) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(map(_shown, value)) + "]"
    return f"{value:.12g}" if isinstance(value, float) else show(value)
