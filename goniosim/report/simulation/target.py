"""A target in words: what is asked for, how far it is, and that it was not reached."""

import numpy as np

from ...accuracy import norm, paths_for
from ...engine.estimate import COMPONENT_OF
from ...scene.model import LIMITS
from ...scene.quantity import percent
from .. import text
from . import accuracy
from .trend import trend


def limits(simulation):
    """Name the limits of a target.

    Parameters
    ----------
    simulation : goniosim.scene.Simulation

    Returns
    -------
    str
        ``at most 1e9 rays per direction and 10 min``, or nothing without limits.
    """
    found = []
    if simulation.max_rays is not None:
        found.append(f"{text.count(simulation.max_rays)} rays per direction")
    if simulation.max_time is not None:
        found.append(text.duration(simulation.max_time))
    return f"at most {' and '.join(found)}" if found else ""


def asked(simulation):
    """Say how much is to be traced.

    Parameters
    ----------
    simulation : goniosim.scene.Simulation

    Returns
    -------
    str
        ``rays per direction: 1e7``, or ``target: 1 % of slice, at most 10 min``.
    """
    if simulation.target is None:
        return f"rays per direction: {text.count(simulation.rays)}"
    return ", ".join(filter(None, [f"target: {simulation.target}", limits(simulation)]))


def far(simulation, outlook):
    """Say what a target still takes.

    Parameters
    ----------
    simulation : goniosim.scene.Simulation
    outlook : goniosim.engine.outlook.Outlook

    Returns
    -------
    str
        One line.
    """
    names = " and ".join(COMPONENT_OF[side] for side in outlook.sides)
    more = f"{_paths_and_time(outlook.needed, outlook.seconds)} more"
    beyond = f", beyond the limits: {limits(simulation)}" if outlook.is_cut else ""
    if np.isinf(outlook.error):
        at = f"of {names} too little was seen for an error after {text.count(outlook.paths)} rays per direction"
        return f"{at}; the target of {simulation.target} takes over {more}{beyond}"
    at = f"{names} is at {percent(outlook.error)} after {text.count(outlook.paths)} rays per direction"
    return f"{at}; the target of {simulation.target} takes about {more}{beyond}"


def _paths_and_time(paths, seconds):
    return f"{text.count(float(f'{paths:.1g}'))} rays per direction and {text.duration(seconds)}"


def shortfall(simulation, result=None):
    """Say that a target was not reached.

    Parameters
    ----------
    simulation : goniosim.scene.Simulation
        Of a result whose ``target_reached`` is False.
    result : goniosim.result.Result, optional
        That result, to tell what the target would take.

    Returns
    -------
    str
        One line, with the remedy.
    """
    names = [name for name in LIMITS if getattr(simulation, name) is not None]
    within = f" with {limits(simulation)}" if names else ""
    remedy = f"raise {' or '.join(names)}, or ask for less" if names else "ask for less"
    if simulation.estimator == "operator":
        remedy += ", or leave the estimator to auto: what nodes may be off by limits this one"
    unknown = result and _unknown(simulation.target, result)
    if unknown:
        price = f" ({unknown[0]}: {accuracy.unknown(result, *unknown)})"
        remedy = "ask for rays instead" if accuracy.is_too_faint(result, *unknown) else remedy
    else:
        price = "" if result is None else _price(simulation.target, result)
    return f"the target of {simulation.target} was not reached{within}{price}; the result is kept: {remedy}"


def _unknown(target, result):
    """Name and direction of a component whose error is unknown; None if all are known."""
    for name in (name for name, component in result.components.items() if component.sampled):
        _, bounds = accuracy.errors(result, name, target.of)
        if np.isinf(bounds).any():
            return name, int(np.argmax(bounds))
    return None


def _price(target, result):
    """What the component takes that is furthest from a target; nothing where that is not known."""
    found = []
    for name in (name for name, component in result.components.items() if component.sampled):
        _, bounds = accuracy.errors(result, name, target.of)
        worst, course = int(np.argmax(bounds)), trend(result, name)
        off = _off(result, name, worst)
        paths = paths_for(target.relative_error, bounds[worst], off, course.rays, course.slope)
        found.append((paths, course.fixed + course.per_ray * paths, bounds[worst]))
    paths, seconds, held = max(found, default=(0.0, 0.0, 0.0))
    if not held > target.relative_error or not 0.0 < paths < np.inf:
        return ""
    return f" (it is at {percent(held)}, and takes about {_paths_and_time(paths, seconds)} in all)"


def _off(result, name, m):
    """What nodes may be off by, relative to the slice."""
    component = result.components[name]
    if component.node_bias is None:
        return 0.0
    size = np.where(result.cells.valid[m], result.cells.projected_solid_angle[m], 0.0)
    whole = float(norm(component.energy[m], size).mean())
    return component.node_bias[m] / whole if whole > 0.0 else 0.0
