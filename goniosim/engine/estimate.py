"""From tallies to numbers with error bars."""

import numpy as np

from ..effective import uncertain
from ..result import AUDIT_ENTRIES, INTEGRATED, Audit, Cells, Component
from ..sums import Paths, sum_and_error
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


def direction_noise(stderr, geometry, weights):
    """Noise floor of one direction: see `goniosim.result.Cost.error`.

    Parameters
    ----------
    stderr : ndarray, shape (distinct channels, rows, columns)
        Of the energy, whatever the estimator.
    geometry : goniosim.slices.Geometry
    weights : ndarray, shape (distinct channels,)
        From `channel_weights`.

    Returns
    -------
    float
    """
    squared = to_bsdf(stderr, geometry) ** 2 * geometry.projected_solid_angle
    return float(np.sqrt(squared.sum(axis=(1, 2))) @ weights)


def channel_weights(plan):
    """Share of each distinct channel in the mean over all: one that stands for several counts as often."""
    return np.bincount(plan.position, minlength=plan.n_distinct) / len(plan.position)


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


def _assemble(plan, slices, rays, contains_delta):
    """A `Component` from energy, stderr and hits per direction on the distinct channels.

    ``rays`` is None for a component that is integrated, whose errors are added; ``hits`` are then of no use.
    ``slices`` may be a generator: of fine slices, only those of one direction are in memory besides the result.
    """
    shape = (len(plan.theta_deg), len(plan.position), plan.rows, plan.columns)
    found = Component(
        *(np.empty(shape) for _ in range(4)),
        hits=None if rays is None else np.empty((shape[0], *shape[2:]), np.int64),
        contains_delta=contains_delta,
        uncertain=None if rays is None else np.empty(shape, bool),
        albedo=np.empty(shape[:2]),
        albedo_stderr=np.empty(shape[:2]),
        estimator=[INTEGRATED if rays is None else "analog"] * shape[0],
    )
    for m, (energy, stderr, hits) in enumerate(slices):
        found.energy[m] = energy[plan.position]
        found.stderr[m] = stderr[plan.position]
        found.bsdf[m] = to_bsdf(energy, plan.geometry[m])[plan.position]
        found.bsdf_stderr[m] = to_bsdf(stderr, plan.geometry[m])[plan.position]
        if rays is None:
            value, error = energy.sum(axis=(1, 2)), stderr.sum(axis=(1, 2))
        else:
            found.hits[m] = hits
            found.uncertain[m] = uncertain(energy, stderr, rays[m])[plan.position]
            value, error = sum_and_error(energy, stderr, Paths(energy, rays[m]))
        found.albedo[m], found.albedo_stderr[m] = value[plan.position], error[plan.position]
    return found


def _sampled(plan, tallies, rays, first, count, contains_delta):
    def slices():
        for tally, n in zip(tallies, rays, strict=True):
            total, squares, hits = moments(tally.histogram, plan, first, count)
            yield *mean_and_error(total, squares, n), hits

    return _assemble(plan, slices(), rays, contains_delta)


def components(plan, tallies, rays, direct):
    """All components of the result.

    Parameters
    ----------
    plan : Plan
    tallies : list of Tally
        One for each direction.
    rays : list of int
        Rays traced from each direction.
    direct : list of (ndarray, ndarray)
        What `direct.direct_reflection` yields for each direction.

    Returns
    -------
    dict of str to goniosim.result.Component
    """
    found = {"reflection/direct": _assemble(plan, ((*pair, None) for pair in direct), None, bool(plan.mirrors[0]))}
    for side, name in COMPONENT_OF.items():
        first, count, lowest = (int(value) for value in plan.slots[side])
        if count == 0:
            continue
        delta = plan.has_specular_chain(side)
        found[name] = _sampled(plan, tallies, rays, first, count, delta)
        if plan.orders:
            for i in range(count):
                order = f"order_{lowest + i}" + ("_and_more" if i == count - 1 else "")
                found[name].orders[order] = _sampled(plan, tallies, rays, first + i, 1, delta)
    return found


def noise(plan, tallies, rays, side):
    """Noise floor of a component in each direction, shape (M,): see `goniosim.result.Cost.error`."""
    first, count, _ = (int(value) for value in plan.slots[side])
    weights = channel_weights(plan)
    return np.array(
        [
            direction_noise(mean_and_error(*moments(tally.histogram, plan, first, count)[:2], n)[1], geometry, weights)
            for tally, n, geometry in zip(tallies, rays, plan.geometry, strict=True)
        ]
    )


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
