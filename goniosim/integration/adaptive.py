"""Adaptive integration over cells, to a stated tolerance.

All cells are divided together, level by level. A part is settled once the sum of the rules on its own parts agrees
with the rule on the whole, the nodes foretell what is at its border, where a kink may hide from them, and it does not
hold the peak of a lobe that is too narrow to be seen by the rule: around a peak, cells are divided down to the width
of the lobe, however narrow, and across it only.
"""

from dataclasses import dataclass

import numpy as np

from .border import retell, unseen
from .division import ALL_TOLD, MOST_PARTS, UNSEEN_PEAK, divide, whole_cells
from .rule import Rule, evaluate

# Two to four times as fine each: no lobe that the coordinates can tell from a Dirac needs as many.
MAX_LEVELS = 64
# Parts of one cell.
MAX_PARTS = 20_000
# Cells integrated at a time, so that memory stays bounded on fine slices; fewer if they are divided into
# so many parts.
CHUNK = 1 << 15
MOST_PENDING = 1 << 18
# Of a smooth integrand that is settled, the nodes may seem not to see some times what the rules differ by.
SPARED = 4.0
_NO_LOBE = np.array([np.inf, np.inf, 1.0, 1.0])


@dataclass(frozen=True)
class Adaptive:
    """Result of an adaptive integration over n cells.

    Attributes
    ----------
    energy : ndarray, shape (channels, n)
        Fraction of the incident flux.
    error : ndarray, shape (channels, n)
        Sum of the differences of successive rules, or of what they may not see at a border: as a rule far above the
        true error. Infinite where a lobe is too narrow to be seen.
    exhausted : ndarray of bool, shape (n,)
        Cells that were given up at the last level, short of the tolerance.
    """

    energy: np.ndarray
    error: np.ndarray
    exhausted: np.ndarray


def integrate_adaptively(density, grid, pool, numbers, *, relative=0.0, absolute=0.0, lobe=None, nodes=5, stop=None):
    """Energy of a density in cells of a slice, to a tolerance.

    Parameters
    ----------
    density : Density
    grid : Grid
    pool : Pool
    numbers : ndarray of int, shape (n,)
        Cells to integrate, of ``grid.all_numbers``: also those that the horizon cuts.
    relative : float
        Difference of successive rules on any part of a cell, relative to the energy of the cell.
    absolute : float or ndarray, shape (n,)
        Difference that is allowed besides.
    lobe : Lobe, optional
        Where the density is narrower than the cells.
    nodes : int
        Nodes of the Gauss-Legendre rule along each side.
    stop : threading.Event, optional
        When set, the integration is given up.

    Returns
    -------
    Adaptive or None
        None if it was given up.
    """
    absolute = np.broadcast_to(np.asarray(absolute, float), numbers.shape)
    rule = Rule(nodes)
    peak = _NO_LOBE if lobe is None else np.array([lobe.u, lobe.psi, lobe.scale_u, lobe.scale_psi])
    chunks = []
    start, length = 0, CHUNK
    while start < len(numbers):
        if stop is not None and stop.is_set():
            return None
        part = slice(start, start + length)
        found = _integrate(density, grid, pool, numbers[part], relative, absolute[part], peak, rule)
        if found is None:
            length = max(1, min(length, len(numbers) - start) // 4)
            continue
        chunks.append(found)
        start += length
    if not chunks:
        none = np.zeros((density.channels, 0))
        return Adaptive(none, none.copy(), np.zeros(0, bool))
    return Adaptive(*(np.concatenate(arrays, axis=-1) for arrays in zip(*chunks, strict=True)))


def _integrate(density, grid, pool, numbers, relative, absolute, peak, rule):
    """Energy, error and whether it was given up, of some cells; None if they are too many at a time."""
    light = grid.light
    n = len(numbers)
    settled_energy = np.zeros((density.channels, n))
    error = np.zeros((density.channels, n))
    exhausted = np.zeros(n, bool)
    spent = np.zeros(n, np.int64)
    rectangles, owner, copies = whole_cells(grid, numbers)
    whole, bends, _ = evaluate(density, grid, rule, rectangles, pool)
    square = np.zeros(len(rectangles), bool)
    for level in range(MAX_LEVELS):
        parts = np.empty((MOST_PARTS * len(rectangles), 4))
        parent = np.empty(len(parts), np.int64)
        quarter = np.empty(len(parts), np.int8)
        premature = np.empty(len(rectangles), np.int8)
        count = divide(grid.code, light, peak, rectangles, bends, square, premature, parts, parent, quarter)
        parts, parent, quarter = parts[:count], parent[:count], quarter[:count]
        values, part_bends, told = evaluate(density, grid, rule, parts, pool, quarter)
        sums = _added(values, parent, len(rectangles))
        difference = np.abs(sums - whole)
        estimate = settled_energy + _added(sums, owner, n)
        tolerance = (relative * np.abs(estimate) + absolute)[:, owner]
        close = (difference <= tolerance).all(axis=0)
        fine = close & (premature == ALL_TOLD)
        spent += np.bincount(owner[parent], minlength=n)
        last = (spent > MAX_PARTS)[owner] | (level == MAX_LEVELS - 1)
        ending = (fine | last) & (premature == ALL_TOLD)
        ending, strips = _strips(density, grid, pool, rule, rectangles, ending, parent, quarter, told)
        fine[ending] &= (strips <= SPARED * tolerance[:, ending]).all(axis=0)
        difference[:, ending] = np.maximum(difference[:, ending], strips)
        given_up = ~fine & last
        exhausted[owner[given_up]] = True
        error[:, owner[given_up & (premature == UNSEEN_PEAK)]] = np.inf
        done = fine | given_up
        settled_energy += _added(sums[:, done], owner[done], n)
        error += _added(difference[:, done], owner[done], n)
        if done.all():
            break
        again = ~done[parent]
        if n > 1 and np.count_nonzero(again) > MOST_PENDING:
            return None
        rectangles, whole, bends = parts[again], values[:, again], part_bends[:, again]
        # Divided along one side and close, the other side is still to be tried; and quarters tell of their borders.
        square = close[parent[again]]
        owner = owner[parent[again]]
    return settled_energy * copies, error * copies, exhausted


def _strips(density, grid, pool, rule, rectangles, ending, parent, quarter, told):
    """Numbers of the rectangles marked as ``ending``, and what no node sees in them."""
    (first,) = np.nonzero((quarter == 0) & ending[parent])
    whole = parent[first]
    cut = ending.copy()
    cut[whole] = False
    (cut,) = np.nonzero(cut)
    strips = unseen(density, grid, rule, rectangles[whole], told, first, pool)
    if len(cut):
        told = retell(density, grid, rule, rectangles[cut], pool)
        more = unseen(density, grid, rule, rectangles[cut], told, np.arange(0, len(told), 4), pool)
        strips = np.concatenate([strips, more], axis=1)
    return np.concatenate([whole, cut]), strips


def _added(values, group, n):
    """Sums of values [channel, m] over the members of each of ``n`` groups."""
    return np.stack([np.bincount(group, weights=row, minlength=n) for row in values])
