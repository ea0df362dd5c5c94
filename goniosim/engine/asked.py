"""Which wishes of a scene the engine can fulfil."""

from ..errors import ConfigError

_KNOWN = ("auto", "analog")


def require_known(simulation):
    """Make sure that nothing is asked for that the engine does not do.

    Parameters
    ----------
    simulation : goniosim.scene.Simulation

    Raises
    ------
    ConfigError
        With one line for each wish.
    """
    problems = []
    if simulation.estimator not in _KNOWN:
        problems.append(f"simulation.estimator: {simulation.estimator} is not available yet: use auto or analog")
    if simulation.target is not None:
        problems.append("simulation.target: is not available yet: give rays instead")
    if problems:
        raise ConfigError(problems)
