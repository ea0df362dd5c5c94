"""More absorption never makes anything brighter, a whiter base never darker: in each cell, path by path."""

import copy

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from goniosim.engine import simulate
from goniosim.scene import parse_scene
from laws.law import law
from laws.strategies import many_faced, scenes, spread, stacks, thin, with_layers

LEAVES = ("reflected_internal", "transmitted")


def grey(numbers):
    """The same in all channels."""
    return numbers


def ordered(layers):
    """The same with the red channel brightest, and the blue one darkest."""
    layers = copy.deepcopy(layers)
    for layer in layers:
        (part,) = layer.values()
        for key, falling in (("tau", False), ("rho", True)):
            if isinstance(part.get(key), list):
                part[key].sort(reverse=falling)
    return layers


@law(fast=10, slow=200, scene=scenes(stacks(of_metals=grey)))
def test_the_channel_that_absorbs_more_is_darker(scene):
    """Channels share their paths, roulette included: to rounding, wherever several numbers are added up."""
    result = simulate(parse_scene(with_layers(scene, ordered(scene["material"]["layers"]))))
    for name, component in result.components.items():
        is_darker(component.energy[:, 1:], component.energy[:, :-1], name)
        is_darker(component.albedo[:, 1:], component.albedo[:, :-1], name)
    for entry in LEAVES:
        is_darker(result.audit.energy[entry][:, 1:], result.audit.energy[entry][:, :-1], entry)


@law(
    fast=6,
    slow=150,
    scene=scenes(many_faced(most=4, taus=thin, rhos=st.floats(0.1, 1.0), of_metals=grey), estimators=("analog",)),
    more=spread(1e-3, 1.0),
    less=st.floats(0.5, 0.99),
)
def test_a_darker_material_is_darker(scene, more, less):
    """Of the same random numbers, where no path was long enough for roulette, which ends other paths then."""
    layers = copy.deepcopy(scene["material"]["layers"])
    for layer in layers:
        (part,) = layer.values()
        for key, change in (("tau", lambda x: x + more), ("rho", lambda x: x * less)):
            if key in part:
                part[key] = [change(x) for x in part[key]] if isinstance(part[key], list) else change(part[key])
    before, after = (simulate(parse_scene(each)) for each in (scene, with_layers(scene, layers)))
    assume(not any(each.audit.energy["lost_roulette"].any() for each in (before, after)))
    for name, component in after.components.items():
        is_darker(component.energy, before.components[name].energy, name)
    for entry in LEAVES:
        is_darker(after.audit.energy[entry], before.audit.energy[entry], entry)
    np.testing.assert_array_equal(after.audit.energy["reflected_direct"], before.audit.energy["reflected_direct"])


def is_darker(dark, bright, name):
    """Not brighter than rounding of a sum of positive numbers lets it seem."""
    assert (dark <= bright * (1.0 + 1e-12)).all(), name
