"""A target in words: what is asked for, and that it was not reached."""

from ...scene.model import LIMITS
from .. import text


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


def shortfall(simulation):
    """Say that a target was not reached.

    Parameters
    ----------
    simulation : goniosim.scene.Simulation
        Of a result whose ``target_reached`` is False.

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
    return f"the target of {simulation.target} was not reached{within}; the result is kept: {remedy}"
