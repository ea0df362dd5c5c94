"""Channels that have next to nothing in common."""

from collections.abc import Iterator

import numpy as np

from ...engine import simulate
from ...scene import Scene
from ..check import Check, absolute, in_sigmas
from ..energy import closes, sane
from ..oracles import adding
from ..ways import by_estimator, excess

# Seeds whose scatter is held against error bars.
SEEDS = 100


def channels_1e6_apart(scene: Scene) -> Iterator[Check]:
    """Blue is a millionth of red: its albedo is right, and its error bars say how far off it is."""
    exact = adding.energies(scene).internal
    for name in dict(by_estimator(scene)):
        yield from _honest(scene, name, exact)


def _honest(scene: Scene, name: str, exact: np.ndarray) -> Iterator[Check]:
    first = scene.simulation.seed
    results = [simulate(scene, estimator=name, seed=seed) for seed in range(first, first + SEEDS)]
    found = [result.components["reflection/internal"] for result in results]
    values = np.array([component.albedo for component in found])
    errors = np.array([component.albedo_stderr for component in found])
    mean, scatter = values.mean(axis=0), values.std(axis=0, ddof=1) / SEEDS**0.5
    yield in_sigmas(f"{name}: albedo, mean of {SEEDS} seeds", mean, scatter, exact)
    for channel, colour in enumerate(("red", "green", "blue")):
        ratio, sigmas = excess(values[..., channel], errors[..., channel], exact[:, channel])
        yield in_sigmas(f"{name}: mean square error in squared bars, {colour}", ratio, (ratio - 1.0) / sigmas, 1.0)
    energy = np.array([component.energy for component in found])
    bars = np.array([component.stderr for component in found])
    certain = np.array([~component.uncertain for component in found]) & (bars > 0.0)
    truth = energy.mean(axis=0)
    deviations = np.divide(energy - truth, bars, out=np.zeros_like(bars), where=certain)
    beyond = (np.abs(deviations) > 3.0).sum() / max(certain.sum(), 1)
    # Normal numbers: 0.27 %; those that rest on sixteen paths of unequal weights have longer tails.
    yield absolute(f"{name}: share of cells beyond 3 error bars, uncertain ones left out", beyond, 0.0, 0.02)


def mirror_in_red_black_in_blue(scene: Scene) -> Iterator[Check]:
    """A base that reflects all red and no blue: nothing red is absorbed, nothing blue comes back."""
    exact = adding.energies(scene)
    for name, result in by_estimator(scene):
        internal = result.components["reflection/internal"]
        for channel, colour in enumerate(("red", "green", "blue")):
            yield in_sigmas(
                f"{name}: {colour}",
                internal.albedo[:, channel],
                internal.albedo_stderr[:, channel],
                exact.internal[:, channel],
                1.0 / result.rays.min(),
            )
        absorbed = result.audit.energy["absorbed_base"]
        # Of a mirror of kappa 1e6 and eta 1: 1 - R is about 4 / 1e12.
        yield absolute(f"{name}: red absorbed by the base", absorbed[:, 0], 0.0, 1e-10)
        yield absolute(f"{name}: blue that comes back", internal.albedo[:, 2], 0.0, 1e-12)
        yield closes(result)
        yield sane(result)


CASES = (channels_1e6_apart, mirror_in_red_black_in_blue)
