"""Measurements of how well the engine agrees with its oracles.

The tests hold them against limits; ``benchmarks/validation.py`` prints them.
"""

import threading

import numpy as np

from goniosim.engine import simulate
from goniosim.engine.drive import Drive
from goniosim.engine.layout import DOWN, UP
from goniosim.engine.plan import make_plan
from goniosim.engine.session import Session

from .cell_integrals import integrate_cells
from .chi_square import chi_square
from .closed_forms import plastic_density, reflection_density, transmission_density
from .scenes import conductor, dielectric, lambert, make_scene, medium
from .tracer import stack_from_scene, trace

ENOUGH_HITS = 30


def _chi_squares(energies, density, thetas, parametrization, rays):
    """Chi-squares of every cell and of blocks of 10 by 30 cells, one of each per incident direction.

    Single cells would show a local error, blocks a small one that many cells share.
    `density` is a function of the power of the weight.
    """
    cells, blocks = [], []
    for energy, theta in zip(energies, thetas, strict=True):
        # Grey scenes: all channels must hold the same numbers.
        assert (energy == energy[0]).all()
        mean, second = (
            integrate_cells(density(power), theta, *energy.shape[1:], parametrization, absolute=1e-10)
            for power in (1, 2)
        )
        cells.append(chi_square(energy[0], mean, second, rays))
        blocks.append(chi_square(*(_blocks(a) for a in (energy[0], mean, second)), rays))
    return cells, blocks


def _blocks(cells):
    rows, columns = cells.shape
    return cells.reshape(rows // 10, 10, columns // 30, 30).sum(axis=(1, 3))


def _estimates(scene, side, seed=None):
    """What is known of a way out, by direction; the direct reflection takes an integral of its own, and is left out."""
    plan = make_plan(scene)
    asked = scene.simulation if seed is None else scene.simulation.model_copy(update={"seed": seed})
    session = Session(plan, asked, Drive(2, threading.Event(), lambda done, total: None))
    session.run()
    (run,) = (each for each in session.runs if side in each.sides)
    return [run.estimate(side, m) for m in range(len(plan.theta_deg))], plan.position


def _energies(scene, side):
    found, position = _estimates(scene, side)
    return np.array([each.energy[position] for each in found])


def plastic_cells(thetas, parametrization, rays, seed, estimator="analog"):
    """Chi-squares of an absorbing smooth coat over a Lambertian base."""
    asked = {"rays": rays, "seed": seed, "estimator": estimator}
    energies = _energies(make_scene([dielectric(1.5), medium(0.2), lambert(0.5)], thetas, parametrization, **asked), UP)
    return _chi_squares(energies, lambda power: plastic_density(1.5, 0.5, 0.2, power), thetas, parametrization, rays)


def conductor_cells(alpha, thetas, parametrization, rays, seed, estimator="analog"):
    """Chi-squares of a bare rough conductor, sampled.

    The engine integrates the direct reflection of the top interface. Below an
    index-matched smooth interface, which reflects nothing, the same conductor
    is sampled.
    """
    layers = [dielectric(1.0), conductor(1.45, 1.0, alpha)]
    asked = {"rays": rays, "seed": seed, "estimator": estimator}
    energies = _energies(make_scene(layers, thetas, parametrization, **asked), UP)
    return _chi_squares(
        energies, lambda power: reflection_density(alpha, 1.45 + 1.0j, power), thetas, parametrization, rays
    )


def transmission_cells(alpha, eta, thetas, rays, seed, estimator="analog"):
    """Chi-squares of the light refracted by one rough interface."""
    asked = {"rays": rays, "seed": seed, "estimator": estimator}
    energies = _energies(make_scene([dielectric(eta, alpha)], thetas, **asked), DOWN)
    return _chi_squares(energies, lambda power: transmission_density(alpha, eta, power), thetas, "classic", rays)


def direct_cells(top, density, thetas, parametrization, rows=90, columns=360):
    """The direct reflection of one interface as integrated by the engine, and by the oracle.

    Returns
    -------
    energy, stderr, exact : ndarray, shape (M, rows, columns)
    """
    result = simulate(make_scene([top], thetas, parametrization, rows, columns), rays=1000, seed=1)
    direct = result.components["reflection/direct"]
    exact = [integrate_cells(density, theta, rows, columns, parametrization) for theta in thetas]
    return direct.energy[:, 0], direct.stderr[:, 0], np.array(exact)


def many_seeds(layers, theta, component, parametrization, rays, seeds, rows=30, columns=60, first=0):
    """Energy, standard error and hits of one component for many seeds, seeds first."""
    scene = make_scene(layers, theta, parametrization, rows, columns, rays=rays, estimator="analog")
    side = DOWN if component == "transmission" else UP
    energy, stderr, hits = [], [], []
    for seed in range(first, first + seeds):
        (found,), position = _estimates(scene, side, seed)
        energy.append(found.energy[position])
        stderr.append(found.stderr[position])
        hits.append(found.hits)
    return np.array(energy), np.array(stderr), np.array(hits)


def exchange_deviations(layers, component, thetas, rays, seed, rows=90, columns=24):
    """Standardised differences f(l, v) - f(v, l) in the first channel, for all pairs of angles.

    The slice of light a, in the row of b, is compared with the slice of b in the row of a;
    columns are the same difference of azimuth in both. The angles must be centres of rows, so
    that the averages over a row's theta_v agree with the exact theta of the light to second order.
    """
    result = simulate(make_scene(layers, thetas, "classic", rows, columns), rays=rays, seed=seed, estimator="analog")
    found = result.components[component]
    row = [int(theta * rows / 90.0) for theta in thetas]
    z = []
    for a in range(len(thetas)):
        for b in range(a):
            there, back = (a, 0, row[b]), (b, 0, row[a])
            error2 = found.bsdf_stderr[there] ** 2 + found.bsdf_stderr[back] ** 2
            enough = (found.hits[a, row[b]] >= ENOUGH_HITS) & (found.hits[b, row[a]] >= ENOUGH_HITS)
            difference = found.bsdf[there] - found.bsdf[back]
            z.append(difference[enough] / np.sqrt(error2[enough]))
    return np.concatenate(z)


def tracer_deviations(layers, theta, parametrization, rays, tracer_rays, orders=3, rows=9, columns=18, seed=3):
    """Standardised differences between the engine and the reference tracer.

    Returns
    -------
    dict of str to ndarray
        By component, and by component and order; all channels of all cells in which the
        tracer counted 100 rays.
    result : goniosim.result.Result
    """
    scene = make_scene(layers, theta, parametrization, rows, columns, orders=orders)
    result = simulate(scene, rays=rays, seed=seed, estimator="analog")
    slow = trace(stack_from_scene(scene), theta, tracer_rays, seed + 1, rows, columns, parametrization, orders + 1)
    # Both follow the same law, and the engine's many rays know its width better.
    widened = np.sqrt(1.0 + rays / tracer_rays)
    deviations = {}
    for name, component in result.components.items():
        counted = np.broadcast_to(slow.hits[name] >= 100, slow.energy[name].shape)
        if component.hits is None:
            # Integrated, not sampled: the scatter is the tracer's alone.
            z = (slow.energy[name] - component.energy[0])[counted] / slow.stderr[name][counted]
            deviations[name] = z
            continue
        deviations[name] = _standardised(component, slow.energy[name], widened, counted)
        for key, part in component.orders.items():
            order = int(key.split("_")[1]) - 1
            # Where the tracer knows a part to 10 %, its error is nearly normal.
            common = counted & (slow.orders[name][order] > 10.0 * slow.order_stderr[name][order])
            deviations[f"{name}/{key}"] = _standardised(part, slow.orders[name][order], widened, common)
    return deviations, result


def _standardised(component, energy, widened, where):
    return (component.energy[0] - energy)[where] / (widened * component.stderr[0])[where]
