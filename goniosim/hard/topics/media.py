"""Stacks of many layers, and media that absorb nothing or everything."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...engine import simulate
from ...report.text import counted
from ...scene import Scene
from ..check import Check, absolute
from ..energy import as_added, closes, sane
from ..oracles import adding
from ..variants import varied

# Rays for a number of interfaces: events grow with its square.
STACKS = {1: 200_000, 2: 200_000, 10: 200_000, 50: 100_000, 300: 20_000}


def white_furnace_50_coats(scene: Scene) -> Iterator[Check]:
    """Fifty smooth coats without absorption over white: all light comes back, ray by ray."""
    result = simulate(scene)
    energy = result.audit.energy
    reflected = energy["reflected_direct"] + energy["reflected_internal"]
    kept = reflected + energy["lost_event_cap"]
    yield absolute("reflected, with what a limit on events cut short", kept, 1.0, 1e-12)
    yield absolute("cut short by the limit on events", energy["lost_event_cap"], 0.0, 1e-4)
    yield closes(result)
    yield sane(result)


def smooth_stacks(scene: Scene) -> Iterator[Check]:
    """Stacks of 1 to 300 smooth interfaces and media, over air, agree with exact adding."""
    *period, last = (layer.model_dump(exclude_none=True) for layer in scene.material.layers)
    for count, rays in STACKS.items():
        layers = [*(period * (count // 5 + 1))[: 2 * count - 2], last]
        stack = varied(scene, {"material.layers": layers, "simulation.rays": rays})
        for check in as_added(simulate(stack), adding.energies(stack)):
            yield replace(check, checked=f"{counted(count, 'interface')}: {check.checked}")


def dark_stack(scene: Scene) -> Iterator[Check]:
    """Optical depths of 4, 7 and 10: what little comes through is right, in spite of roulette."""
    result = simulate(scene)
    yield from as_added(result, adding.energies(scene))
    energy, stderr = result.audit.energy["lost_roulette"], result.audit.stderr["lost_roulette"]
    yield absolute("roulette's balance, in standard errors", np.abs(energy) / np.maximum(stderr, 1e-300), 0.0, 6.0)


CASES = (white_furnace_50_coats, smooth_stacks, dark_stack)
