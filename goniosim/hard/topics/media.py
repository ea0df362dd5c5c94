"""Media that absorb nothing or everything, and stacks of many layers."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...engine import simulate
from ...report.text import counted
from ...scene import Scene
from ..check import Check, absolute, in_sigmas, statement
from ..energy import as_added, closes, sane
from ..oracles import adding
from ..variants import varied
from ..ways import by_estimator

# Rays for a number of interfaces: events grow with its square.
STACKS = {1: 200_000, 2: 200_000, 10: 200_000, 50: 100_000, 300: 20_000}


def absorbing_nothing(scene: Scene) -> Iterator[Check]:
    """Optical depths of 0, 1e-12 and 1e-9: slices as without them, and what is absorbed has its digits."""
    thin = simulate(scene)
    clear = simulate(varied(scene, {"material.layers.1.medium.tau": 0}))
    for path, component in thin.components.items():
        found, without = component.energy, clear.components[path].energy
        yield absolute(f"{path}, against a clear medium", found[:, :2], without[:, :2], 1e-11)
        # A crossing of 1e-9 takes that much over a cosine of .75.
        yield absolute(f"{path}, tau 1e-09, against a clear medium", found[:, 2], without[:, 2], 2e-9)
    exact = adding.energies(scene)
    absorbed = thin.audit.energy["absorbed_media"]
    # Rounding of weights near 1 is 1e-16 an event, a ten thousandth of 1e-12.
    error = np.hypot(thin.audit.stderr["absorbed_media"], 1e-15)
    for channel, depth in ((1, 1e-12), (2, 1e-9)):
        got, wanted = absorbed[:, channel] / depth, exact.absorbed[:, channel] / depth
        yield in_sigmas(f"absorbed of tau {depth:g}, in units of it", got, error[:, channel] / depth, wanted)
    yield absolute("absorbed of tau 0", absorbed[:, 0], 0.0, 0.0)
    yield closes(thin)


def absorbing_everything(scene: Scene) -> Iterator[Check]:
    """Optical depths of 50, 700 and 1e4: what enters is absorbed, nothing is infinite, negative or lost."""
    result = simulate(scene)
    exact = adding.energies(scene)
    entered = 1.0 - exact.direct
    absorbed = result.audit.energy["absorbed_media"]
    yield in_sigmas("absorbed: all that enters", absorbed, result.audit.stderr["absorbed_media"], entered)
    leaves = result.audit.energy["transmitted"] + result.audit.energy["reflected_internal"]
    yield absolute("leaves after tau 50 or more", leaves, 0.0, 1e-20)
    yield closes(result)
    yield sane(result)


def infinite_beside_zero(scene: Scene) -> Iterator[Check]:
    """A channel of depth 1e9 beside one of depth 0: the clear one is that of a clear stack, by every estimator."""
    clear = simulate(varied(scene, {"material.layers.1.medium.tau": 0, "simulation.seed": 2}))
    for name, result in by_estimator(scene):
        for path, component in result.components.items():
            if component.sampled:
                error = np.hypot(component.albedo_stderr[:, 0], clear.components[path].albedo_stderr[:, 0])
                expected = clear.components[path].albedo[:, 0]
                yield in_sigmas(f"{name}, {path}: the clear channel", component.albedo[:, 0], error, expected)
                yield absolute(f"{name}, {path}: the black channel", component.albedo[:, 1], 0.0, 0.0)
        yield closes(result)
        yield sane(result)


def underflowing_products(scene: Scene) -> Iterator[Check]:
    """Ten media of depth 80: their product has no number of its own, and no audit misses it."""
    result = simulate(scene)
    exact = adding.energies(scene)
    audit = result.audit
    yield absolute("transmitted", audit.energy["transmitted"], 0.0, 1e-30)
    yield in_sigmas(
        "reflected internal",
        audit.energy["reflected_internal"],
        audit.stderr["reflected_internal"],
        exact.internal,
        1.0 / result.rays.min(),
    )
    yield closes(result)
    yield sane(result)


def black_and_white_bases(scene: Scene) -> Iterator[Check]:
    """Albedos of 0, 0.5 and 1 under a smooth coat follow the closed form: nothing from black, everything from white."""
    exact = adding.energies(scene)
    for name, result in by_estimator(scene):
        internal = result.components["reflection/internal"]
        yield in_sigmas(f"{name}: grey", internal.albedo[:, 1], internal.albedo_stderr[:, 1], exact.internal[:, 1])
        yield in_sigmas(f"{name}: white", internal.albedo[:, 2], internal.albedo_stderr[:, 2], exact.internal[:, 2])
        yield absolute(f"{name}: black", internal.albedo[:, 0], 0.0, 0.0)
        # A path that carries all light and loses none of it cannot miss any.
        absorbed = result.audit.energy["absorbed_base"][:, 2]
        yield absolute(f"{name}: absorbed by white", absorbed, 0.0, 0.0)
        yield closes(result)


def white_furnace_1_coat(scene: Scene) -> Iterator[Check]:
    """A smooth coat without absorption over white: all light comes back, ray by ray."""
    yield from _furnace(scene)


def white_furnace_5_coats(scene: Scene) -> Iterator[Check]:
    """Five coats, the strongest of index 3, over white: all light comes back, ray by ray."""
    yield from _furnace(scene)


def white_furnace_50_coats(scene: Scene) -> Iterator[Check]:
    """Fifty smooth coats without absorption over white: all light comes back, ray by ray."""
    yield from _furnace(scene)


def _furnace(scene: Scene) -> Iterator[Check]:
    result = simulate(scene)
    energy = result.audit.energy
    reflected = energy["reflected_direct"] + energy["reflected_internal"]
    yield absolute("reflected", reflected, 1.0, 1e-12)
    yield absolute("cut short by the limit on events", energy["lost_event_cap"], 0.0, 0.0)
    total, stderr = result.albedo("reflection")
    yield in_sigmas("sum over the cells", total, stderr, 1.0)
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
    exact = adding.energies(scene)
    for name, result in by_estimator(scene):
        for check in as_added(result, exact):
            yield replace(check, checked=f"{name}: {check.checked}")
        energy, stderr = result.audit.energy["lost_roulette"], result.audit.stderr["lost_roulette"]
        yield in_sigmas(f"{name}: balance of roulette", energy, stderr, 0.0)


def dark_rough_stack(scene: Scene) -> Iterator[Check]:
    """Rough interfaces around depths of 4, 7 and 10: all estimators agree with independent paths."""
    results = dict(by_estimator(scene))
    yield statement("estimators that apply", len(results) > 2, "3 or more", ", ".join(results))
    analog = results.pop("analog")
    for name, result in results.items():
        for path, component in result.components.items():
            if component.sampled:
                other = analog.components[path]
                error = np.hypot(component.albedo_stderr, other.albedo_stderr)
                yield in_sigmas(f"{name} against analog, {path}", component.albedo, error, other.albedo)


CASES = (
    absorbing_nothing,
    absorbing_everything,
    infinite_beside_zero,
    underflowing_products,
    black_and_white_bases,
    white_furnace_1_coat,
    white_furnace_5_coats,
    white_furnace_50_coats,
    smooth_stacks,
    dark_stack,
    dark_rough_stack,
)
