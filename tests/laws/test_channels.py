"""Channels are alike: whatever stands first, and whatever the others hold, follows the same paths."""

import numpy as np
from hypothesis import strategies as st

from goniosim.engine import simulate
from goniosim.scene import parse_scene
from laws.alike import in_order
from laws.law import law
from laws.strategies import scenes, stacks, unequal, with_layers
from sameness import FIELDS

orders = st.sampled_from([[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]])


@law(fast=10, slow=200, scene=scenes(stacks(fewest=2, colours=unequal)), order=orders)
def test_permuted_channels_give_permuted_results(scene, order):
    """Bit for bit: roulette and splitting look at the brightest channel, and at no place."""
    layers = in_order(scene["material"]["layers"], order)
    found, expected = simulate(parse_scene(with_layers(scene, layers))), simulate(parse_scene(scene))
    for name, component in found.components.items():
        other = expected.components[name]
        for field in FIELDS:
            np.testing.assert_array_equal(getattr(component, field), getattr(other, field)[:, order], f"{name} {field}")
        for label, part in component.orders.items():
            np.testing.assert_array_equal(part.energy, other.orders[label].energy[:, order])
    for entry, energy in found.audit.energy.items():
        np.testing.assert_array_equal(energy, expected.audit.energy[entry][:, order], entry)
        np.testing.assert_array_equal(found.audit.stderr[entry], expected.audit.stderr[entry][:, order], entry)
