"""Deposits of what leaves: into cells, into rows that stand for rings, or at systematic azimuths.

The light stands at phi = 0 and all layers are isotropic, so an even number of columns is folded: |phi| is binned.
After a Lambertian event the azimuth is uniform. Where a row of the slice is a ring about the normal, the deposit
belongs to the whole row; elsewhere it is made at azimuths in equal steps from a random start.
"""

from ..._jit import stage
from ...optics.elementary import sincos_turns
from ...optics.random import derive_key, uniform
from ...slices import cells_of
from ..layout import WEIGHT
from ..loops import multiply
from .layout import (
    AMOUNT,
    FACET_RATIO,
    RADIUS,
    RATIO,
    THROUGH_GAIN,
    THROUGH_X,
    THROUGH_Y,
    THROUGH_Z,
    TURN,
)
from .queues import list_alive

# Azimuths of an exit that has forgotten its own: more cost as much as other paths, and tell less.
AZIMUTHS = 64

# Of them, how many cost as much as meeting an interface.
_AZIMUTHS_PER_EVENT = 2
_AZIMUTH_KEY = 2


@stage
def leave(way, batch, n, free, key, channels, scratch, sources, cells):
    """Deposit the refracted rays that leave upwards (way 0) or downwards (1), by the shares in ``AMOUNT``.

    Parameters
    ----------
    free : bool
        Whether their azimuth is uniform.
    key : uint64
    sources : ndarray of uint32
        Overwritten: which ray of the batch each deposit stems from.
    cells : tuple
        Parametrization, rows, columns, light, slots, cells of the deposits (overwritten), histograms of cells and of
        rings, whether rows are rings, whether columns are folded.

    Returns
    -------
    int
        Events that cost as much as the deposits, beyond one for each ray.
    """
    parametrization, rows, columns, light, slots, places, histogram, rings, rows_are_rings, folded = cells
    x, y, z, amount = scratch[THROUGH_X], scratch[THROUGH_Y], scratch[THROUGH_Z], scratch[AMOUNT]
    m = list_alive(amount, n, sources)
    if m < n:
        for row in range(THROUGH_X, AMOUNT + 1):
            _gather(scratch[row], m, sources)
    ring = free and rows_are_rings
    spin = free and not rows_are_rings
    table = rings if ring else histogram
    columns = 1 if ring else columns
    if spin:
        _radii(x, y, m, derive_key(key, _AZIMUTH_KEY), scratch[RADIUS], scratch[TURN], amount)
    elif folded:
        _fold(y, m)
    for number in range(AZIMUTHS if spin else 1):
        if spin:
            _spin(scratch[RADIUS], scratch[TURN], m, number, (0.5 if folded else 1.0) / AZIMUTHS, x, y)
        cells_of(parametrization, x, y, z, m, rows, columns, light, places)
        _choose_slot(batch, sources, m, channels, slots[way], rows * columns, places)
        _add(table, places, sources, amount, batch, m, channels)
    return m * AZIMUTHS // _AZIMUTHS_PER_EVENT if spin else 0


@stage
def share_out(batch, n, share, rough, scratch):
    """Shares of the refracted rays of ``n`` rays: of the gain, times the ratios of all densities."""
    _product(scratch[THROUGH_GAIN], batch[RATIO], n, share, scratch[AMOUNT])
    if rough:
        multiply(scratch[AMOUNT], n, scratch[FACET_RATIO])


@stage
def _product(gain, ratio, n, share, amount):
    for i in range(n):
        amount[i] = gain[i] * ratio[i] * share


@stage
def _gather(row, m, sources):
    # To a place that is not after its own.
    for i in range(m):
        row[i] = row[sources[i]]


@stage
def _fold(y, n):
    # Views are minus directions in x and y.
    for i in range(n):
        y[i] = -abs(y[i])


@stage
def _radii(x, y, n, key, radius, turn, amount):
    for i in range(n):
        radius[i] = (x[i] * x[i] + y[i] * y[i]) ** 0.5
        turn[i] = uniform(key, i)
        amount[i] *= 1.0 / AZIMUTHS


@stage
def _spin(radius, turn, n, number, step, x, y):
    for i in range(n):
        sine, cosine = sincos_turns((turn[i] + number) * step)
        x[i] = -radius[i] * cosine
        y[i] = -radius[i] * sine


@stage
def _choose_slot(batch, sources, n, channels, slot, size, places):
    first, count, first_order = slot
    if count == 1:
        for i in range(n):
            places[i] += first * size
    else:
        order = batch[WEIGHT + channels]
        for i in range(n):
            places[i] += (first + min(int(order[sources[i]]) - first_order, count - 1)) * size


@stage
def _add(histogram, places, sources, amount, batch, n, channels):
    if channels == 3:
        _add_three(histogram, places, sources, amount, batch[WEIGHT], batch[WEIGHT + 1], batch[WEIGHT + 2], n)
        return
    for c in range(channels):
        weight = batch[WEIGHT + c]
        for i in range(n):
            histogram[places[i], c] += weight[sources[i]] * amount[i]


@stage
def _add_three(histogram, places, sources, amount, red, green, blue, n):
    for i in range(n):
        share = amount[i]
        source = sources[i]
        cell = histogram[places[i]]
        cell[0] += red[source] * share
        cell[1] += green[source] * share
        cell[2] += blue[source] * share
