"""What accuracy a result has, where it is worst, and what more of it would cost."""

import numpy as np

from ...accuracy import bound, relative_error
from ...albedo import arrived
from ...engine.estimate import COMPONENT_OF
from ...engine.plan import make_plan
from ...engine.reach import most_light
from ...scene import parse_scene
from ...scene.quantity import percent
from ...sums import noise_of
from .. import text
from .audit import unseen
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
        if np.isinf(found[worst]) or not arrived(result.components[name]).any():
            known = unknown(result, name, worst) if np.isinf(found[worst]) else "dark: no light leaves this way"
            lines.append(f"  {name.ljust(width)}   {known}" + ("" if target is None else f" (target {target})"))
            continue
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
        Standard errors, and what a target is held against; infinite where too little was seen to know them, and 0
        where no light can leave or none was traced.
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
    made = np.array(found).T
    if np.isinf(made).any():
        made[:, np.isinf(made[0]) & (_is_dark(result, name) | (result.rays == 0))] = 0.0
    return made


def unknown(result, name, direction):
    """Say why the error of a component is unknown in a direction.

    Parameters
    ----------
    result : goniosim.result.Result
    name : str
    direction : int

    Returns
    -------
    str
        ``nothing was seen at 89 deg: at most 2e-05``, or that it is too little.
    """
    at = f"at {text.angles(result.theta_deg)[direction]} deg"
    if is_too_faint(result, name, direction):
        return f"too little was seen {at} for an error to be known, by any number of rays"
    return f"nothing was seen {at}: at most {unseen(result, direction)}"


def is_too_faint(result, name, direction):
    """Of a component whose error is unknown in a direction: whether something was seen, of which no rays tell more."""
    return bool(arrived(result.components[name])[direction].any())


def _is_dark(result, name):
    plan = make_plan(parse_scene(result.config_yaml))
    (side,) = (side for side, of in COMPONENT_OF.items() if of == name)
    return np.array([most_light(plan, side, m) == 0.0 for m in range(len(result.theta_deg))])
