"""What each effect costs: one scene, grey and without absorption, against the same scene with more.

    python benchmarks/effects.py [--rays 2e7] [--repeat 5]

Prints nanoseconds of processor time per event (a ray meets an interface) and per ray, and the time
per event relative to the plain scene. Events are the same for all rows but those that change the
paths themselves. The variants are measured in turns, in one run, on one thread; the best of the
repetitions counts.

A second table shows what must cost nothing: layers that no ray meets, and effects that are written
out but do nothing. It holds the time per ray of either way of writing a scene against that of the
other, with every estimator, as the mean of ratios within a turn with its standard error.
"""

import argparse
import threading

import numpy as np

from goniosim.engine.faint import faint_weights
from goniosim.engine.plan import make_plan
from goniosim.engine.unit import Tally, Workspace, unit_key
from goniosim.report.cost.runs import ESTIMATORS, run
from goniosim.scene import parse_scene

COAT = {"interface": {"type": "dielectric", "eta": 1.5, "alpha": 0.2}}
SMOOTH_COAT = {"interface": {"type": "dielectric", "eta": 1.5}}
RAYS_PER_UNIT = 1 << 18


def _base(rho):
    return {"interface": {"type": "lambert", "rho": rho}}


def _medium(tau):
    return {"medium": {"tau": tau}}


VARIANTS = {
    "plain: grey, clear": ([COAT, _base(0.5)], {}),
    "tau 0 written out": ([COAT, _medium(0.0), _base([0.5, 0.5, 0.5])], {}),
    "+ grey absorption": ([COAT, _medium(0.01), _base(0.5)], {}),
    "+ colour": ([COAT, _base([0.5, 0.49, 0.48])], {}),
    "+ colour and absorption": ([COAT, _medium([0.01, 0.011, 0.012]), _base([0.5, 0.49, 0.48])], {}),
    "+ orders": ([COAT, _base(0.5)], {"orders": 3}),
    "- roughness": ([SMOOTH_COAT, _base(0.5)], {}),
}

METAL = {"interface": {"type": "conductor", "eta": 1.45, "kappa": 1.0, "alpha": 0.2}}
# Nothing gets through it.
BLACK = _medium(1e3)
# By what is said in the second of two scenes, which do the same to light.
SAME = {
    "tau 0 written out": ([COAT, METAL], [COAT, _medium(0.0), METAL]),
    "three equal channels": ([COAT, _medium(0.1), METAL], [COAT, _medium([0.1, 0.1, 0.1]), METAL]),
    "an interface of equal indices": ([COAT, METAL], [COAT, COAT, METAL]),
    "layers below black ones": (
        [COAT, BLACK, METAL],
        [COAT, BLACK, COAT, _medium(0.1), SMOOTH_COAT, _medium(0.1), METAL],
    ),
}


def measure(workspaces, rays, repeat):
    """Best processor seconds, and the events, of every variant."""
    best = dict.fromkeys(workspaces, float("inf"))
    events = {}
    units = max(1, rays // RAYS_PER_UNIT)
    for turn in range(repeat + 1):
        for name, (workspace, tally) in workspaces.items():
            seconds = 0.0
            events[name] = 0
            for unit in range(units if turn else 1):
                tally.clear()
                report = workspace.run(0, RAYS_PER_UNIT, unit_key(1, 0, unit), tally, threading.Event())
                seconds += report.cpu_seconds
                events[name] += report.events
            if turn:  # the first turn compiles
                best[name] = min(best[name], seconds)
    return best, events, units * RAYS_PER_UNIT


def compare(first, second, estimator, rays, repeat):
    """Time per ray of the second of two scenes over that of the first, and the standard error of the ratio."""
    logs = []
    for turn in range(repeat + 1):
        found = [run(scene, estimator, rays, seed=1, threads=1) for scene in (first, second)]
        if turn:  # the first turn compiles
            logs.append(np.log(found[1].cpu_seconds.sum() / found[0].cpu_seconds.sum()))
    ratio = np.exp(np.mean(logs))
    return ratio, ratio * np.std(logs, ddof=1) / np.sqrt(len(logs))


def scene_of(layers, simulation=None):
    """A scene of some layers, lit from 30 degrees."""
    return parse_scene(
        {
            "material": {"name": "benchmark", "layers": layers},
            "incident": {"theta_deg": [30]},
            "simulation": {"rays": 1e6, **(simulation or {})},
        }
    )


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rays", type=float, default=4e6)
    parser.add_argument("--repeat", type=int, default=9)
    options = parser.parse_args()
    workspaces = {}
    for name, (layers, simulation) in VARIANTS.items():
        plan = make_plan(scene_of(layers, simulation))
        workspaces[name] = (Workspace(plan, faint_weights(plan)), Tally(plan))
    best, events, rays = measure(workspaces, int(options.rays), options.repeat)
    plain = next(iter(VARIANTS))
    print(f"{'scene':26}{'ns/ray':>9}{'ns/event':>10}{'relative':>10}")
    for name, seconds in best.items():
        per_event = seconds / events[name]
        relative = per_event / (best[plain] / events[plain])
        print(f"{name:26}{seconds / rays * 1e9:9.1f}{per_event * 1e9:10.2f}{relative:10.2f}")
    print("\ntime per ray with what must cost nothing, over that without; independent of it at 1")
    print(f"{'':32}" + "".join(f"{estimator:>18}" for estimator in ESTIMATORS))
    for name, pair in SAME.items():
        first, second = map(scene_of, pair)
        ratios = [compare(first, second, each, int(options.rays), options.repeat) for each in ESTIMATORS]
        print(f"{name:32}" + "".join(f"{ratio:10.3f} ± {error:.3f}" for ratio, error in ratios), flush=True)


if __name__ == "__main__":
    main()
