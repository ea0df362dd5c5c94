"""What accuracy a result has, where it is worst, and what more of it would cost."""

import numpy as np

from ...accuracy import bound, relative_error
from ...scene import parse_scene
from ...scene.quantity import percent
from ...sums import noise_of
from .. import text
from .trend import trend

# What is told of more accuracy.
FACTORS = (3, 10)


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
        held = "" if target is None else f", nine in ten errors below {percent(bounds[worst])} (target {target})"
        course = trend(result, name)
        more = ", ".join(
            f"{factor} times better {course.about} {text.duration(course.seconds_for(factor))}" for factor in FACTORS
        )
        lines.append(f"  {name.ljust(width)}   {percent(found[worst])} at {angle} deg{held}; {more}")
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
