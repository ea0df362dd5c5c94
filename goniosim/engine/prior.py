"""What finished runs have yielded, as far as it takes to go on from there: read from a result, kept in a state."""

from dataclasses import dataclass, fields

import numpy as np

from ..errors import UnusableResultError
from ..provenance import version_of
from ..result import Audit, Cost
from ..scene.quantity import count
from ..sums import BATCHES, BLOCKS
from .assembly import order_labels
from .estimate import COMPONENT_OF, Estimate
from .packing import array
from .unit import child_key

# Child of the seed's key, for what is traced besides what is there.
BRANCH = 6
# Words of a result that hold for one that goes on from it.
LASTING = ("estimator_gain", "merged_seeds")


@dataclass(eq=False)
class Slices:
    """Estimates of one component, or of one of its orders, in all directions, on the distinct channels D.

    Attributes
    ----------
    energy, stderr : ndarray, shape (M, D, R, K)
    albedo_stderr : ndarray, shape (M, D)
    paths : ndarray of int64, shape (M,)
    hits, batches, node_bias, replicates : ndarray or None
        As of `goniosim.result.Component`.
    """

    energy: np.ndarray
    stderr: np.ndarray
    albedo_stderr: np.ndarray
    paths: np.ndarray
    hits: np.ndarray | None
    batches: np.ndarray | None
    node_bias: np.ndarray | None
    replicates: np.ndarray | None

    def estimate(self, m):
        """The `goniosim.engine.estimate.Estimate` of a direction."""
        paths = int(self.paths[m])
        return Estimate(
            self.energy[m],
            self.stderr[m],
            self.albedo_stderr[m],
            paths if self.batches is None else int(self.replicates[m]),
            hits=None if self.hits is None else self.hits[m],
            batches=None if self.batches is None else self.batches[m],
            bias=None if self.node_bias is None else float(self.node_bias[m]),
            paths=paths,
        )


class Prior:
    """Estimates of all ways out, with their energy balance and their cost.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    tree : dict
        As of `state`.

    Raises
    ------
    ValueError, TypeError, LookupError, AttributeError
        If it is none of this plan.

    Attributes
    ----------
    estimators : dict of str to str
        By component.
    audit : goniosim.result.Audit
    cost : goniosim.result.Cost
    seeds : list of int
        Of all runs that it is made of.
    provenance : dict of str to str
        What a result that goes on from here says of it.
    """

    def __init__(self, plan, tree):
        self._tree, shapes = tree, _shapes(plan)
        labels = {name: ("", *found) for name, found in order_labels(plan).items()}
        self._slices = {
            (name, label): Slices(**{each: _checked(values[each], *shapes[each]) for each in shapes})
            for name in labels
            for label, values in zip(labels[name], tree["slices"][name], strict=True)
        }
        self._labels = labels
        self.estimators = {name: str(tree["estimators"][name]) for name in labels}
        for part in self._slices.values():
            if (part.hits is None) == (part.batches is None) or (part.batches is None) != (part.replicates is None):
                raise ValueError("it has neither hits nor batches")
        totals = (len(plan.theta_deg), len(plan.position))
        audit, cost = tree["audit"], tree["cost"]
        self.audit = Audit(
            energy={name: array(value, totals) for name, value in audit["energy"].items()},
            stderr={name: array(value, totals) for name, value in audit["stderr"].items()},
            direct_integrated=array(audit["direct_integrated"], totals),
            direct_integrated_stderr=array(audit["direct_integrated_stderr"], totals),
            rays=array(audit["rays"], totals[:1], np.int64),
        )
        if any((rays < 0).any() for rays in (self.audit.rays, *(part.paths for part in self._slices.values()))):
            raise ValueError("a number of light paths is negative")
        noted = (totals[0], len(cost["rays"].T))
        self.cost = Cost(
            *(array(cost[name], noted) for name in ("rays", "seconds", "cpu_seconds")),
            error={name: array(cost["error"][name], noted) for name in labels},
        )
        if not self.cost.checkpoints:
            raise ValueError("it does not say what it cost")
        self.seeds = [int(seed) for seed in tree["seeds"]]
        self.provenance = {str(name): str(words) for name, words in tree["provenance"].items()}

    def state(self):
        """As a tree for `packing.pack`."""
        return self._tree

    @property
    def size(self):
        """Bytes of its slices."""
        arrays = [getattr(part, field.name) for part in self._slices.values() for field in fields(part)]
        return sum(each.nbytes for each in arrays if each is not None)

    def rays(self, sides):
        """Light paths of each direction in all of some ways out, ndarray of int64, shape (M,)."""
        if not sides:
            # Where nothing else leaves, there is the balance alone.
            return self.audit.rays
        return np.min([self._slices[COMPONENT_OF[side], ""].paths for side in sides], axis=0)

    def estimate(self, side, direction, order=None):
        """As `goniosim.engine.analog.AnalogRun.estimate`."""
        name = COMPONENT_OF[side]
        return self._slices[name, self._labels[name][0 if order is None else 1 + order]].estimate(direction)

    def key(self, seed):
        """Key (uint64) of random numbers that nothing of what is there has used."""
        key = child_key(seed, BRANCH)
        numbers = [*self.seeds, *self.audit.rays]
        for name in sorted(self.estimators):
            numbers += list(self._slices[name, ""].paths)
        for number in numbers:
            key = child_key(key, int(number))
        return key


def read_prior(plan, result):
    """The estimates of a result.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
        Of the same scene, the seed perhaps aside.
    result : goniosim.result.Result

    Returns
    -------
    Prior

    Raises
    ------
    goniosim.errors.UnusableResultError
        If it is of another version of goniosim, or does not hold what it takes.
    """
    version, own = result.provenance.get("goniosim_version"), version_of("goniosim")
    if version != own:
        raise UnusableResultError(f"it is of goniosim {version}, and this is {own}")
    try:
        return Prior(plan, _tree(plan, result))
    except (ValueError, TypeError, LookupError, AttributeError) as error:
        raise UnusableResultError(f"it does not hold what it takes to go on: {error}") from error


def seeds_of(seed, provenance):
    """Seeds of all runs that a result is made of.

    Parameters
    ----------
    seed : int
        Its own.
    provenance : mapping
        Its, or the attributes of its file.

    Returns
    -------
    list of int
    """
    merged = provenance.get("merged_seeds")
    return [int(each) for each in merged.split(",")] if merged else [seed]


def _tree(plan, result):
    slices, estimators = {}, {}
    for name in order_labels(plan):
        component = result.components[name]
        if component.paths is None or result.audit.rays is None:
            raise ValueError("it does not say how many light paths each component has")
        (estimators[name],) = set(component.estimator)
        slices[name] = [_of(plan, part) for part in (component, *component.orders.values())]
    least, most = (count(int(value)) for value in (result.rays.min(), result.rays.max()))
    words = f"{least if least == most else f'{least} to {most}'} rays per direction"
    lasting = {name: said for name, said in result.provenance.items() if name in LASTING}
    return {
        "slices": slices,
        "estimators": estimators,
        "audit": {field.name: getattr(result.audit, field.name) for field in fields(Audit)},
        "cost": {field.name: getattr(result.cost, field.name) for field in fields(Cost)},
        "seeds": seeds_of(result.seed, result.provenance),
        "provenance": {**lasting, "extended_from": f"{words}, of {result.provenance['created_utc']}"},
    }


def _of(plan, component):
    """Arrays of a component by name, on the distinct channels."""
    found = {field.name: getattr(component, field.name) for field in fields(Slices)}
    for name, axis in (("energy", 1), ("stderr", 1), ("albedo_stderr", 1), ("batches", 2)):
        if found[name] is not None and len(plan.distinct) < len(plan.position):
            found[name] = np.take(found[name], plan.distinct, axis=axis)
    return found


def _shapes(plan):
    """Shape and type of each array of `Slices`, and whether it must be there."""
    m, d, cells = len(plan.theta_deg), plan.n_distinct, (plan.rows, plan.columns)
    blocks = tuple(min(n, most) for n, most in zip(cells, BLOCKS, strict=True))
    return {
        "energy": ((m, d, *cells), float, True),
        "stderr": ((m, d, *cells), float, True),
        "albedo_stderr": ((m, d), float, True),
        "paths": ((m,), np.int64, True),
        "hits": ((m, *cells), np.int64, False),
        "batches": ((m, BATCHES, d, *blocks), float, False),
        "node_bias": ((m,), float, False),
        "replicates": ((m,), np.int64, False),
    }


def _checked(values, shape, dtype, needed):
    """A copy-free look at an array of a tree; a ValueError if it is none of that shape and type."""
    if values is None and not needed:
        return None
    if not isinstance(values, np.ndarray) or values.dtype != dtype or values.shape != shape:
        raise ValueError(f"an array of shape {shape} is missing")
    return values
