"""Layers written otherwise: to light they are the same, or the same in other channels."""

import copy
import itertools

from goniosim.scene.optical import EQUAL
from reference.scenes import dielectric, medium


def places(layers):
    """Where a medium or an interface may come in, within a stack: below each interface but the last."""
    return [at for at in range(1, len(layers)) if "interface" in layers[at - 1]]


def in_parts(layers, at, parts):
    """A medium more, and the same medium in parts, which are added up from the top."""
    *_, whole = itertools.accumulate(parts)
    return [*layers[:at], medium(whole), *layers[at:]], [*layers[:at], *map(medium, parts), *layers[at:]]


def with_nothing(layers, at, shift, alpha):
    """An interface more, between indices whose ratio is 1 but for a shift."""
    index = min(max(_index_above(layers, at) * (1.0 + shift), 0.1), 10.0)
    return [*layers[:at], dielectric(index, alpha), *layers[at:]]


def _index_above(layers, at):
    """Index at a place in the stack, as light knows it."""
    index = 1.0
    for layer in layers[:at]:
        eta = layer["interface"]["eta"] if "interface" in layer else index
        index = index if abs(eta / index - 1.0) <= EQUAL else eta
    return index


def in_triples(layers):
    """Three equal numbers for one, wherever channels may differ."""
    return _changed(layers, lambda value: value if isinstance(value, list) else [value] * 3)


def in_order(layers, order):
    """The channels in another order."""
    return _changed(layers, lambda value: [value[c] for c in order] if isinstance(value, list) else value)


def _changed(layers, change):
    layers = copy.deepcopy(layers)
    for layer in layers:
        (part,) = layer.values()
        for key in ("rho", "tau") if part.get("type") != "conductor" else ("eta", "kappa"):
            if key in part:
                part[key] = change(part[key])
    return layers
