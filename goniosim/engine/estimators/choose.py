"""Which estimator serves which way out of a stack: by widths, and by how much accuracy is asked for."""

from dataclasses import dataclass

from ...errors import ConfigError
from ..analog import AnalogRun
from ..layout import DOWN, UP
from ..plan import make_plan
from ..replicated import ReplicatedRun
from ..rounds import FEWEST_PATHS
from . import ESTIMATORS

COMPONENTS = {UP: "reflection/internal", DOWN: "transmission"}
ANALOG, AUTO = "analog", "auto"


@dataclass(frozen=True)
class Choice:
    """An estimator for some ways out, and why.

    Attributes
    ----------
    estimator : str
    sides : tuple of int
    reason : str
        The end of a sentence that begins with the estimator's name.
    """

    estimator: str
    sides: tuple
    reason: str

    def __str__(self):
        return f"{' and '.join(COMPONENTS[side] for side in self.sides) or 'audit'}: {self.estimator} ({self.reason})"

    def start(self, plan, key):
        """A run of it.

        Parameters
        ----------
        plan : goniosim.engine.plan.Plan
        key : int or uint64
            Seed of the random numbers.
        """
        if self.estimator == ANALOG:
            return AnalogRun(plan, key, self.sides)
        estimator = ESTIMATORS[self.estimator](plan, self.sides)
        return ReplicatedRun(plan, estimator, self.sides, key)


def choose(plan, name, rays):
    """Choose estimators.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    name : str
        ``auto``, or the estimator that is asked for.
    rays : int or None
        Light paths of each direction; None if an accuracy is asked for.

    Returns
    -------
    list of Choice
        Together they serve all ways out, each once.

    Raises
    ------
    ConfigError
        If an estimator is asked for by name that does not apply.
    """
    sides = tuple(side for side in (UP, DOWN) if plan.slots[side, 1] > 0)
    if name == ANALOG:
        return [Choice(ANALOG, sides, "as asked for")]
    if name != AUTO:
        return [Choice(name, group, "as asked for") for group in _named(plan, name, sides)]
    if not sides:
        return [Choice(ANALOG, sides, "nothing but the direct reflection leaves")]
    if rays is not None and rays < FEWEST_PATHS:
        return [Choice(ANALOG, sides, f"fewer than {FEWEST_PATHS} rays are too few for replicates")]
    chosen = {side: _best(plan, side) for side in sides}
    together = tuple(side for side in sides if chosen[side][0] == "split")
    made = [Choice(*chosen[side][:1], (side,), chosen[side][1]) for side in sides if side not in together]
    if together:
        made.append(Choice("split", together, chosen[together[0]][1]))
    return sorted(made, key=lambda choice: choice.sides)


def estimators_of(scene):
    """Which estimator serves which component of a scene, and why; without what a pilot of a target may say.

    Parameters
    ----------
    scene : goniosim.scene.Scene

    Returns
    -------
    list of str
    """
    return [str(choice) for choice in choose(make_plan(scene), scene.simulation.estimator, scene.simulation.rays)]


def _best(plan, side):
    """The first that applies, in the order of their gains, and why not those before it."""
    refused = []
    for name, estimator in ESTIMATORS.items():
        reason = estimator.refusal(plan, (side,))
        if reason is None:
            return name, "; ".join(refused) or "the best for this stack"
        refused.append(f"not {name}: {reason}")
    raise AssertionError("the split walk serves every stack")


def next_best(plan, sides, name, reason):
    """The first estimator after ``name`` that serves some ways out, and the reason for leaving that.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    sides : tuple of int
    name : str
    reason : str

    Returns
    -------
    Choice
    """
    names = list(ESTIMATORS)
    later = names[names.index(name) + 1 :]
    return Choice(next(each for each in later if ESTIMATORS[each].refusal(plan, sides) is None), sides, reason)


def _named(plan, name, sides):
    """Groups of ways out that one instance of the estimator serves."""
    estimator = ESTIMATORS[name]
    if sides and estimator.refusal(plan, sides) is None:
        return [sides]
    reasons = {side: estimator.refusal(plan, (side,)) for side in sides}
    wrong = [f"{COMPONENTS[side]}: {reason}" for side, reason in reasons.items() if reason is not None]
    if wrong or not sides:
        raise ConfigError(
            f"simulation.estimator: {name} does not apply to this scene: "
            f"{'; '.join(wrong) or 'nothing but the direct reflection leaves'}; use auto"
        )
    return [(side,) for side in sides]
