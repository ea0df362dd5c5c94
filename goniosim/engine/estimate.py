"""From tallies to numbers with error bars."""

from dataclasses import dataclass

import numpy as np

from ..accuracy import norm
from ..effective import uncertain
from ..result import AUDIT_ENTRIES, Audit, Cells, Component
from ..sums import Batches, Paths
from .layout import DOWN, UP

COMPONENT_OF = {UP: "reflection/internal", DOWN: "transmission"}


def cells(plan):
    """The `goniosim.result.Cells` of a plan."""
    return Cells(
        parametrization=plan.parametrization_name,
        row_edges=np.linspace(0.0, 90.0, plan.rows + 1),
        column_edges=np.linspace(0.0, 360.0, plan.columns + 1),
        valid=np.stack([g.valid for g in plan.geometry]),
        solid_angle=np.stack([g.solid_angle for g in plan.geometry]),
        projected_solid_angle=np.stack([g.projected_solid_angle for g in plan.geometry]),
    )


def moments(histogram, plan, first, count):
    """Sums over histograms ``first`` to ``first + count - 1``.

    Returns
    -------
    total, squares : ndarray, shape (distinct channels, rows, columns)
    hits : ndarray, shape (rows, columns)
    """
    d = plan.n_distinct
    shape = (plan.n_slots, plan.rows, plan.columns, histogram.shape[1])
    part = histogram.reshape(shape)[first : first + count].sum(axis=0)
    return np.moveaxis(part[..., :d], -1, 0), np.moveaxis(part[..., d : 2 * d], -1, 0), part[..., 2 * d]


def mean_and_error(total, squares, rays):
    """Mean per ray, and its standard error from the scatter of the paths; 0 where there were no rays."""
    n = max(rays, 2)
    mean = total / n
    return mean, np.sqrt(np.maximum(squares - total * mean, 0.0) / (n * (n - 1.0)))


def to_bsdf(energy, geometry):
    """Divide by the projected solid angle of the cells; 0 in cells that are not valid."""
    valid = geometry.valid & (geometry.projected_solid_angle > 0.0)
    return np.divide(energy, geometry.projected_solid_angle, out=np.zeros_like(energy), where=valid)


def channel_weights(plan):
    """Share of each distinct channel in the mean over all: one that stands for several counts as often."""
    return np.bincount(plan.position, minlength=plan.n_distinct) / len(plan.position)


def noise(plan, direction, energy):
    """Norm of an error of energies in one direction, mean over the channels: see `goniosim.result.Cost.error`.

    Parameters
    ----------
    plan : Plan
    direction : int
    energy : ndarray, shape (distinct channels, rows, columns)

    Returns
    -------
    float
        In sr^-1/2.
    """
    return float(norm(energy, valid_size(plan, direction)) @ channel_weights(plan))


def valid_size(plan, direction):
    """Projected solid angles of the cells in sr, 0 for those that are not valid; ndarray, shape (rows, columns)."""
    geometry = plan.geometry[direction]
    return np.where(geometry.valid, geometry.projected_solid_angle, 0.0)


def shared_seconds(elapsed, cpu_seconds):
    """Elapsed time shared out among the directions, between checkpoints in proportion to their processor time.

    Parameters
    ----------
    elapsed : ndarray, shape (P,)
    cpu_seconds : ndarray, shape (M, P)

    Returns
    -------
    ndarray, shape (M, P)
        Its sum over directions is ``elapsed``; never less than at the checkpoint before.
    """
    spent = np.diff(cpu_seconds, prepend=0.0, axis=1)
    total = spent.sum(axis=0)
    shares = np.divide(spent, total, out=np.full_like(spent, 1.0 / len(spent)), where=total > 0.0)
    return np.cumsum(shares * np.diff(elapsed, prepend=0.0), axis=1)


@dataclass
class Estimate:
    """One component, or one of its orders, in one direction, on the distinct channels D.

    Attributes
    ----------
    energy, stderr : ndarray, shape (D, R, K)
        Fractions of the incident flux.
    total_stderr : ndarray, shape (D,)
        Of the sum over all cells.
    count : int or None
        Paths or replicates whose scatter tells the errors; None if it is integrated.
    hits : ndarray, shape (R, K), or None
        Paths that arrived, if they are counted.
    batches : ndarray, shape (B, D, row blocks, column blocks), or None
        See `goniosim.result.Component.batches`.
    bias : float or None
        What nodes may be off by, in sr^-1/2.
    paths : int or None
        Light paths; None if it is integrated.
    """

    energy: np.ndarray
    stderr: np.ndarray
    total_stderr: np.ndarray
    count: int | None = None
    hits: np.ndarray | None = None
    batches: np.ndarray | None = None
    bias: float | None = None
    paths: int | None = None

    @property
    def noise(self):
        """How the noise of the cells hangs together, see `goniosim.sums`."""
        if self.batches is None:
            return Paths(self.energy, self.count)
        return Batches(self.energy, self.stderr, self.batches)


def assemble(plan, estimates, estimator, contains_delta):
    """Make a component of what its directions hold.

    Parameters
    ----------
    plan : Plan
    estimates : iterable of Estimate
        One for each direction; a generator: of fine slices, those of one direction are in memory besides the result.
    estimator : str
    contains_delta : bool

    Returns
    -------
    goniosim.result.Component
    """
    shape = (len(plan.theta_deg), len(plan.position), plan.rows, plan.columns)
    found = Component(
        *(np.empty(shape) for _ in range(4)),
        contains_delta=contains_delta,
        albedo=np.empty(shape[:2]),
        albedo_stderr=np.empty(shape[:2]),
        estimator=[estimator] * shape[0],
    )
    for m, one in enumerate(estimates):
        found.energy[m] = one.energy[plan.position]
        found.stderr[m] = one.stderr[plan.position]
        found.bsdf[m] = to_bsdf(one.energy, plan.geometry[m])[plan.position]
        found.bsdf_stderr[m] = to_bsdf(one.stderr, plan.geometry[m])[plan.position]
        found.albedo[m] = one.energy.sum(axis=(1, 2))[plan.position]
        found.albedo_stderr[m] = one.total_stderr[plan.position]
        if one.count is not None:
            _put(found, "uncertain", m, uncertain(one.energy, one.stderr, one.count)[plan.position])
        if one.hits is not None:
            _put(found, "hits", m, one.hits.astype(np.int64))
        if one.batches is not None:
            _put(found, "batches", m, one.batches[:, plan.position])
            _put(found, "replicates", m, np.int64(one.count))
        if one.paths is not None:
            _put(found, "paths", m, np.int64(one.paths))
        if one.bias is not None:
            _put(found, "node_bias", m, np.float64(one.bias))
    return found


def _put(component, name, direction, values):
    """Set what one direction holds of an array that not every component has."""
    if getattr(component, name) is None:
        setattr(component, name, np.zeros((len(component.energy), *values.shape), values.dtype))
    getattr(component, name)[direction] = values


def audit(plan, ledgers, part_rays, direct):
    """Energy balance with standard errors from the scatter between parts of work units.

    Parameters
    ----------
    plan : Plan
    ledgers : list of list of ndarray, shape (N_LEDGER, distinct channels)
        Of every part of the finished work units of every direction.
    part_rays : list of list of int
        Rays of those parts.
    direct : goniosim.result.Component
        The integrated direct reflection.
    """
    mean = np.zeros((len(AUDIT_ENTRIES), len(ledgers), plan.n_distinct))
    stderr = np.zeros_like(mean)
    for m, (parts, sizes) in enumerate(zip(ledgers, part_rays, strict=True)):
        mean[:, m], stderr[:, m] = _balance(parts, sizes, plan.n_distinct)
    return Audit(
        energy={name: mean[i][:, plan.position] for i, name in enumerate(AUDIT_ENTRIES)},
        stderr={name: stderr[i][:, plan.position] for i, name in enumerate(AUDIT_ENTRIES)},
        direct_integrated=direct.albedo,
        direct_integrated_stderr=direct.albedo_stderr,
        rays=np.array([sum(sizes) for sizes in part_rays], np.int64),
    )


def _balance(parts, sizes, n_distinct):
    if not parts:
        return np.zeros((len(AUDIT_ENTRIES), n_distinct)), np.zeros((len(AUDIT_ENTRIES), n_distinct))
    sizes = np.array(sizes, dtype=float)[:, None, None]
    parts = np.stack(parts)
    rays = sizes.sum()
    mean = parts.sum(axis=0) / rays
    deviations = ((parts - sizes * mean) ** 2).sum(axis=0)
    return mean, np.sqrt(deviations * len(parts) / (len(parts) - 1.0)) / rays
