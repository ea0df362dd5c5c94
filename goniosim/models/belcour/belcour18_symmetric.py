"""Belcour 2018, symmetric variant: statistics at the cosine l.h instead of l.n, hence reciprocal.

    f(l, v) = sum_k e_k(l.h) D(h; alpha_k) G(l, v; alpha_k) / (4 (l.n) (v.n)),  alpha_k = alpha_k(l.h)

The statistics are tabulated over t = sqrt(l.h), which spreads out the grazing angles, and
interpolated by cubics. Dirac lobes, of smooth interfaces, take theirs from the sweep itself.
"""

import math
from functools import lru_cache

import numpy as np

from ..._jit import kernel
from ...optics.microfacet import microfacet_reflection
from ...scene import distinct_channels
from ..model import Model, Prepared
from ..stack import NARROWEST, ggx_lobe, light_direction
from .lobes import (
    Options,
    belcour_tables,
    lobes_of,
    statistics,
    supports_conductor_base,
)
from .sweep import sweep

NODES = 513


@kernel
def _tabulate(kinds, alphas, etas, spectral, taus, flags, table):
    """Fill ``table`` [node, interface, channels + 1] with energies and widths."""
    n_channels = taus.shape[1]
    energy = np.empty(taus.shape)
    alpha = np.empty(kinds.shape[0])
    total = np.empty((2, n_channels + 1))
    last = table.shape[0] - 1
    for node in range(table.shape[0]):
        t = node / last
        # The sweep divides by the cosine.
        cosine = max(t * t, 1e-7)
        sweep(kinds, alphas, etas, spectral, taus, cosine, flags, energy, alpha, total)
        for k in range(kinds.shape[0]):
            table[node, k, :n_channels] = energy[k]
            table[node, k, n_channels] = alpha[k]


# The same material comes back for every incident direction and component.
@lru_cache(maxsize=16)
def _statistics(material, options):
    kinds, alphas, etas, spectral, taus, flags = belcour_tables(material, options)
    table = np.empty((NODES, len(kinds), taus.shape[1] + 1))
    _tabulate(kinds, alphas, etas, spectral, taus, flags, table)
    return table


@kernel
def evaluate(tables, light, x, y, z, out):
    """Sum of lobes of varying statistics into ``out``; see `goniosim.models.model.Prepared`."""
    table, correlated = tables
    out[:] = 0.0
    n = x.shape[0]
    lx = light[0]
    ly = light[1]
    lz = light[2]
    last = table.shape[1] - 1
    width = table.shape[2] - 1
    first = np.empty(n, np.int64)
    w = np.empty((4, n))
    value = np.empty(n)
    for i in range(n):
        _, cosine = microfacet_reflection(lx, ly, lz, x[i], y[i], z[i], 1.0)
        place = math.sqrt(cosine) * last
        start = min(max(int(place) - 1, 0), last - 3)
        s = place - start
        first[i] = start
        # Lagrange cubic through the nodes 0, 1, 2, 3.
        w[0, i] = (s - 1.0) * (s - 2.0) * (3.0 - s) / 6.0
        w[1, i] = s * (s - 2.0) * (s - 3.0) / 2.0
        w[2, i] = s * (s - 1.0) * (3.0 - s) / 2.0
        w[3, i] = s * (s - 1.0) * (s - 2.0) / 6.0
    for k in range(table.shape[0]):
        for i in range(n):
            alpha = 0.0
            for j in range(4):
                alpha += w[j, i] * table[k, first[i] + j, width]
            lobe, _ = ggx_lobe(lx, ly, lz, x[i], y[i], z[i], min(1.0, max(alpha, NARROWEST)), correlated)
            value[i] = lobe
        for c in range(out.shape[0]):
            o = out[c]
            for i in range(n):
                energy = 0.0
                for j in range(4):
                    energy += w[j, i] * table[k, first[i] + j, c]
                o[i] += max(0.0, energy) * value[i]


def _prepare(scene, theta_i_deg, component, options):
    distinct, position = distinct_channels(scene)
    light = light_direction(theta_i_deg)
    part = lobes_of(component)
    table = _statistics(scene.material, options)[:, part]
    dirac = (table[:, :, -1] == 0.0).all(axis=0)
    # In the mirror direction l.h is l.n.
    energy, _, _, _ = statistics(scene, light[2], options)
    mirror_energy = energy[part][dirac].sum(axis=0)[distinct]
    # Energies of the distinct channels, then the width.
    table = np.ascontiguousarray(table[:, ~dirac][:, :, [*distinct, -1]].transpose(1, 0, 2))
    tables = (table, options.masking == "correlated")
    narrowest = max(table[..., -1].min(initial=1.0), NARROWEST)
    return Prepared(evaluate, tables, light, mirror_energy, position, narrowest)


MODEL = Model(
    name="belcour18_symmetric",
    citation="L. Belcour, Efficient rendering of layered materials using an atomic decomposition with "
    "statistical operators, ACM TOG 37(4), 2018 (symmetric variant)",
    applies_to="reflection off conductor bases, any number of layers",
    options=Options,
    supports=supports_conductor_base,
    prepare=_prepare,
)
