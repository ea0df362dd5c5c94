"""From tallies to numbers with error bars."""

import numpy as np

from ..result import AUDIT_ENTRIES, Audit, Cells, Component
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


def assemble(plan, slices, contains_delta):
    """A `Component` from energy, stderr and hits (None if not counted) per direction on the distinct channels.

    ``slices`` may be a generator: of fine slices, only those of one direction are in memory besides the result.
    """
    shape = (len(plan.theta_deg), len(plan.position), plan.rows, plan.columns)
    found = Component(
        *(np.empty(shape) for _ in range(4)),
        contains_delta=contains_delta,
    )
    for m, (energy, stderr, hits) in enumerate(slices):
        found.energy[m] = energy[plan.position]
        found.stderr[m] = stderr[plan.position]
        found.bsdf[m] = to_bsdf(energy, plan.geometry[m])[plan.position]
        found.bsdf_stderr[m] = to_bsdf(stderr, plan.geometry[m])[plan.position]
        if hits is not None:
            found.hits = np.zeros((shape[0], *shape[2:]), np.int64) if found.hits is None else found.hits
            found.hits[m] = hits
    return found


def channel_weights(plan):
    """Share of each distinct channel in a mean over the channels: one that stands for several counts as often."""
    return np.bincount(plan.position, minlength=plan.n_distinct) / len(plan.position)


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
        direct_integrated=direct.energy.sum(axis=(2, 3)),
        direct_integrated_stderr=direct.stderr.sum(axis=(2, 3)),
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
