"""What accuracy a result has, where it is worst, and what more of it would cost."""

import math

import numpy as np

from ...accuracy import bound, relative_error
from ...scene import parse_scene
from ...sums import noise_of
from .. import text

# What is told of more accuracy.
FACTORS = (3, 10)
# Errors fall with the square root of the time at least, and with the time itself at most, as far as one may hope.
SLOWEST, FASTEST = 0.5, 1.0


def accuracy_lines(result):
    """Accuracy of every component in its worst direction, as what the scene's target is of (``slice`` without one).

    Parameters
    ----------
    result : goniosim.result.Result

    Returns
    -------
    list of str
    """
    target = parse_scene(result.config_yaml).simulation.target
    of = "slice" if target is None else target.of
    lines = [f"Accuracy: relative standard error of {of}, in the worst direction"]
    names = [name for name, component in result.components.items() if component.sampled]
    width = max(map(len, names), default=0)
    for name in names:
        found, bounds = errors(result, name, of)
        worst = int(np.argmax(found if target is None else bounds))
        angle = text.angles(result.theta_deg)[worst]
        held = "" if target is None else f", held against the target: {100.0 * bounds[worst]:.2g} %"
        more = ", ".join(f"{factor} times better about {text.duration(cost)}" for factor, cost in prices(result, name))
        lines.append(f"  {name.ljust(width)}   {100.0 * found[worst]:.2g} % at {angle} deg{held}; {more}")
    return lines if names else []


def errors(result, name, of):
    """Accuracy of a component in all directions, see `goniosim.accuracy`.

    Returns
    -------
    relative_errors, bounds : ndarray, shape (M,)
        Standard errors, and what a target is held against.
    """
    component = result.components[name]
    size = np.where(result.cells.valid, result.cells.projected_solid_angle, 0.0)
    weights = np.full(len(result.channels), 1.0 / len(result.channels))
    found = []
    for m in range(len(result.theta_deg)):
        total = component.albedo[m], component.albedo_stderr[m]
        slices = of, component.energy[m], component.stderr[m], total, size[m], weights
        bias = None if component.node_bias is None else component.node_bias[m]
        found.append((relative_error(*slices), bound(*slices, noise_of(component, m, result.rays[m]), bias)))
    return np.array(found).T


def prices(result, name):
    """Seconds that errors some `FACTORS` smaller would take, by the trend of the last checkpoints."""
    seconds = result.cost.elapsed
    noise = result.cost.noise(name)
    slope = SLOWEST
    if len(seconds) > 1 and noise[-1] > 0.0 and noise[-2] > noise[-1] and seconds[-1] > seconds[-2] > 0.0:
        slope = math.log(noise[-2] / noise[-1]) / math.log(seconds[-1] / seconds[-2])
    slope = min(max(slope, SLOWEST), FASTEST)
    return [(factor, seconds[-1] * factor ** (1.0 / slope)) for factor in FACTORS]
