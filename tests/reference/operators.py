"""Operators compared with runs of the analog engine, in blocks of cells."""

import numpy as np

from goniosim.engine.unit import child_key


def energies(operator, size, replicates, seed, direction=0):
    """Slices of so many replicates, shape (replicates, slots, distinct channels, rows, width)."""
    plan = operator.plan
    out = np.empty((replicates, operator.slots, plan.n_distinct, plan.rows, plan.width))
    workspace = operator.workspace()
    for first in range(0, replicates, operator.chunk):
        last = min(first + operator.chunk, replicates)
        workspace.run(direction, size, [child_key(seed, i) for i in range(first, last)], out[first:last], None)
    return out


def deviations(operator, components, slices, rays, direction=0, least=1e-5, hits=100.0, block=(3, 6)):
    """Standardised differences between an operator and pooled analog runs.

    Parameters
    ----------
    operator : goniosim.engine.estimators.operator.Operator
        On an even number of columns.
    components : list of goniosim.result.Component
        Of independent analog runs of ``rays`` rays each.
    slices : ndarray
        As `energies` yields them.
    least, hits : float
        Blocks are compared that hold so much of the energy of their channel, and so many analog rays of weight one:
        a block without a hit states no error.
    block : (int, int)
        Rows and columns of a block of the folded slice.

    Returns
    -------
    z, totals : ndarray
        Of blocks in all channels, and of the whole slice in each.
    """
    plan = operator.plan
    runs = len(components)
    half = slice(0, plan.width)
    mean = np.mean([c.energy[direction] for c in components], axis=0)[plan.distinct]
    variance = np.mean([c.stderr[direction] ** 2 for c in components], axis=0)[plan.distinct] / runs
    # Twice the folded half, as the operator has it: its variance is that of the whole.
    expected = _blocks(mean[..., half] + mean[..., ::-1][..., half], block)
    noise = _blocks(variance[..., half] + variance[..., ::-1][..., half], block)
    found = _blocks(2.0 * slices.sum(axis=1), block)
    error2 = found.var(axis=0, ddof=1) / len(found)
    total = found.sum(axis=(-2, -1))
    energy = found.mean(axis=0)
    counted = (energy > least * total.mean(axis=0)[:, None, None]) & (energy * rays * runs > hits)
    z = ((energy - expected) / np.sqrt(noise + error2 + 1e-300))[counted]
    spread = np.sqrt(variance.sum(axis=(1, 2)) + total.var(axis=0, ddof=1) / len(found))
    return z, (total.mean(axis=0) - mean.sum(axis=(1, 2))) / spread


def _blocks(cells, block):
    rows, columns = cells.shape[-2:]
    r, c = block
    return cells.reshape(*cells.shape[:-2], rows // r, r, columns // c, c).sum(axis=(-3, -1))
