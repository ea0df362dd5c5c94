"""How hits become numbers with errors, and what estimators do where there is little to count."""

from collections.abc import Iterator

import numpy as np

from ...engine import simulate
from ...engine.estimate import mean_and_error
from ...report.text import duration
from ...scene import Scene
from ..check import Check, in_sigmas, relative, statement, whether
from ..energy import closes, sane
from ..oracles import adding
from ..variants import labelled, varied
from ..ways import by_estimator, excess

# Numbers of rays that no power of two divides, around the sizes at which replicates begin and are divided.
ODD = (101, 9_973, 131_071, 131_073, 200_003, 600_011)
SEEDS = 200


def a_tally_of_1e12_rays(scene: Scene) -> Iterator[Check]:
    """Sums a million times those of a run of a million rays: the same mean, and a thousandth of its error."""
    result = simulate(scene)
    component = result.components["reflection/internal"]
    rays = float(result.rays[0])
    energy, stderr = component.energy[0], component.stderr[0]
    total = energy * rays
    squares = stderr**2 * rays * (rays - 1.0) + total * energy
    mean, error = mean_and_error(total * 1e6, squares * 1e6, rays * 1e6)
    # Of the square of an error 1e-12 of the sum of squares, where a cell has nearly all rays.
    lit = energy > 0.0
    expected = stderr / 1e3 * ((rays - 1.0) / (rays - 1e-6)) ** 0.5
    yield relative("means", mean[lit], energy[lit], 1e-12)
    yield relative("errors", error[lit], expected[lit], 1e-6)
    yield whether("counts are whole beyond 2^32", True, np.float64(1e12) + 1.0 - 1e12 == 1.0)


def one_cell_receives_all(scene: Scene) -> Iterator[Check]:
    """Slices of a single cell: its energy is the albedo, and the error that of all rays."""
    exact = adding.energies(scene)
    for name, result in by_estimator(scene):
        component = result.components["reflection/internal"]
        energy, stderr = component.energy[..., 0, 0], component.stderr[..., 0, 0]
        yield in_sigmas(f"{name}: energy", energy, stderr, exact.internal)
        yield relative(f"{name}: albedo", component.albedo, energy, 1e-12)
        yield relative(f"{name}: error of the albedo", component.albedo_stderr, stderr, 1e-6)
        yield closes(result)


def cells_with_few_hits(scene: Scene) -> Iterator[Check]:
    """Cells with 0, 1, 2 hits and more: unbiased over seeds, and marked as uncertain below sixteen."""
    energies, hits = [], []
    first = scene.simulation.seed
    for seed in range(first, first + SEEDS):
        component = simulate(scene, seed=seed, estimator="analog").components["reflection/internal"]
        energies.append(component.energy[0, 0])
        hits.append(component.hits[0])
    energies, hits = np.array(energies), np.array(hits)
    doubtful = component.uncertain[0, 0]
    seen = [n for n in range(4) if (hits == n).any()]
    yield statement("so few hits are seen in cells", seen == [0, 1, 2, 3], "0, 1, 2, 3", ", ".join(map(str, seen)))
    few = component.hits[0] < 16
    yield statement("cells of fewer than 16 hits are marked", doubtful[few].all(), few.sum(), doubtful[few].sum())
    exact = simulate(varied(scene, {"simulation.estimator": "connection", "simulation.rays": 1_000_000}))
    truth = exact.components["reflection/internal"]
    error = np.hypot(energies.std(axis=0, ddof=1) / SEEDS**0.5, truth.stderr[0, 0])
    # Single cells, each with some hundreds of hits in all; then all of them.
    known = hits.sum(axis=0) >= 400
    yield in_sigmas(
        "single cells, mean over seeds", energies.mean(axis=0)[known], error[known], truth.energy[0, 0][known]
    )
    total = energies.sum(axis=(1, 2))
    yield in_sigmas("all cells", total.mean(), total.std(ddof=1) / SEEDS**0.5, truth.energy[0, 0].sum())


def odd_numbers_of_rays(scene: Scene) -> Iterator[Check]:
    """Rays and replicates that no power of two divides: every estimator is right for all of them."""
    reference = simulate(varied(scene, {"simulation.rays": 4_000_000, "simulation.seed": 99}))
    truth = reference.components["reflection/internal"]
    for rays in ODD:
        for name, result in by_estimator(scene, rays=rays):
            component = result.components["reflection/internal"]
            error = np.hypot(component.albedo_stderr, truth.albedo_stderr)
            yield in_sigmas(f"{name}, {rays} rays", component.albedo, error, truth.albedo, 1.0 / rays)
            at_least = (result.rays >= rays).all()
            yield statement(f"{name}: at least {rays} rays are traced", at_least, f">= {rays}", result.rays.min())


def a_pilot_that_sees_nothing(scene: Scene) -> Iterator[Check]:
    """At 89.999 degrees 4e-5 of the light enters, at 89.9999999 less than 2e-8: nothing seen is not nothing there."""
    exact = adding.energies(scene)
    for name, result in by_estimator(scene):
        value, stderr = result.albedo("reflection/internal")
        yield in_sigmas(f"{name}: albedo", value, stderr, exact.internal)
        yield statement(f"{name}: has an error", (stderr > 0.0).all(), "more than 0", f"{stderr.min():.1g}")
        yield closes(result)
        yield sane(result)
    yield from labelled("target of 5 % at 89.9999999 degrees", _targets(scene))


def _targets(scene: Scene) -> Iterator[Check]:
    """A target where the pilot, and independent paths after it, see nothing."""
    asked = {"target": {"relative_error": 0.05}, "max_rays": 1_000_000, "seed": scene.simulation.seed}
    darker = varied(scene, {"incident.theta_deg": [89.9999999], "simulation": asked})
    result, analog = simulate(darker), simulate(darker, estimator="analog")
    value, stderr = result.albedo("reflection/internal")
    yield in_sigmas("albedo", value, stderr, adding.energies(darker).internal)
    yield whether("it was reached", True, result.target_reached)
    yield whether("analog: it was reached", False, analog.target_reached)


def a_lobe_narrower_than_a_cell(scene: Scene) -> Iterator[Check]:
    """A lobe of a thousandth of a cell: all its light is in that cell, with the right albedo, by every estimator."""
    smooth = adding.energies(
        varied(scene, {"material.layers.0.interface.alpha": 0, "material.layers.1.interface.alpha": 0})
    )
    for name, result in by_estimator(scene):
        component = result.components["reflection/internal"]
        brightest = component.energy.max(axis=(2, 3))
        # Tails of GGX: a share of (alpha / tan)^2 lies outside of the cell.
        yield relative(f"{name}: share of the brightest cell", brightest, component.albedo, 1e-4)
        error = np.hypot(component.albedo_stderr, 1e-5)
        yield in_sigmas(f"{name}: albedo, against smooth", component.albedo, error, smooth.internal)
        yield closes(result)
        yield sane(result)


def a_target_out_of_reach(scene: Scene) -> Iterator[Check]:
    """An error of 1e-7 asked for within a second: the run ends in time, keeps what it has, and says that it missed."""
    result = simulate(scene)
    spent = float(result.cost.seconds[:, -1].sum())
    yield whether("the target was reached", False, result.target_reached)
    yield statement("the result is whole", result.status == "complete", "complete", result.status)
    yield statement("it ends in time", spent < 10.0, "a second, and what was begun", duration(spent))
    value, stderr = result.albedo("reflection/internal")
    longer = simulate(varied(scene, {"simulation": {"rays": 1_000_000, "seed": 7}}))
    other, error = longer.albedo("reflection/internal")
    yield in_sigmas("albedo, against another run", value, np.hypot(stderr, error), other)
    yield closes(result)


def error_bars_of_audits(scene: Scene) -> Iterator[Check]:
    """The error bars of every entry of the audit are those by which seeds differ."""
    first = scene.simulation.seed
    audits = [simulate(scene, seed=seed).audit for seed in range(first, first + SEEDS)]
    for entry in audits[0].energy:
        values = np.array([audit.energy[entry] for audit in audits])
        errors = np.array([audit.stderr[entry] for audit in audits])
        if errors.any():
            ratio, sigmas = excess(values, errors)
            what = f"{entry.replace('_', ' ')}: squared scatter in squared bars"
            yield in_sigmas(what, ratio, (ratio - 1.0) / sigmas, 1.0)


CASES = (
    a_tally_of_1e12_rays,
    one_cell_receives_all,
    cells_with_few_hits,
    odd_numbers_of_rays,
    a_pilot_that_sees_nothing,
    a_lobe_narrower_than_a_cell,
    a_target_out_of_reach,
    error_bars_of_audits,
)
