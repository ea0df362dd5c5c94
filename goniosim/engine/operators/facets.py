"""Facets for a walk that must meet the rare ones too: a defensive mixture of visible normals of three widths.

Rare facets carry the dim tails of wide exits. A tenth of all facets is drawn from wider distributions; the ratio of the
densities is kept apart from the weight, for a roulette that looked at the product would end the very rays drawn for the
tails. Facets of the core have ratios of up to 10 / 9, and light that is caught meets hundreds: the few paths that met
no others would carry all of it. So a path whose ratios have come to a product of `MOST` draws from the plain one alone.
"""

import math

import numpy as np

from ..._jit import scalar, stage
from ...optics.elementary import sincos_turns
from ...optics.ggx import sample_visible_facet
from ...optics.random import random_sincos, uniform
from ..lattice import STEPS, coordinate
from .rays import COSINE, FACET_X, FACET_Y, FACET_Z, KEY, RATIO, WIDTH, X, Y, Z

# Share of each of the two wider distributions, whose widths are sqrt(alpha) and WIDEST.
SHARE = 0.05
WIDEST = 0.5
# Product of the ratios of a path, from which on it draws no wider facets: then its weight stays as it is.
MOST = 2.0
# Random numbers of a ray: azimuth and height of a facet, and the width.
AZIMUTH, HEIGHT, MIXTURE = range(3)


@scalar
def choose_width(alpha, u):
    """Width of the distribution that a facet is drawn from; a smooth interface has one facet."""
    share = SHARE if alpha > 0.0 else 0.0
    return math.sqrt(alpha) if u < share else (WIDEST if u < 2.0 * share else alpha)


@scalar
def meet_facet(x, y, z, alpha, width, cosine, sine, u):
    """A facet as seen from (x, y, z), and the ratio of the density of width ``alpha`` to that of the mixture.

    ``cosine`` and ``sine`` are those of a uniform azimuth, ``u`` is uniform in [0, 1).
    """
    fx, fy, fz = sample_visible_facet(x, y, z, width, cosine, sine, u)
    sin2 = fx * fx + fy * fy
    cos2 = fz * fz
    inverse = 1.0 / math.sqrt(sin2 + cos2)
    # Densities a2 / d of visible normals, but for the factors that they share; one division for all.
    medium = math.sqrt(alpha)
    d0 = _denominator(sin2, cos2, z, alpha)
    d1 = _denominator(sin2, cos2, z, medium)
    d2 = _denominator(sin2, cos2, z, WIDEST)
    plain = alpha * alpha * (d1 * d2)
    wider = alpha * (d0 * d2) + WIDEST * WIDEST * (d0 * d1)
    ratio = plain / ((1.0 - 2.0 * SHARE) * plain + SHARE * wider) if alpha > 0.0 else 1.0
    return fx * inverse, fy * inverse, fz * inverse, ratio


@scalar
def _denominator(sin2, cos2, z, alpha):
    t = alpha * alpha * cos2 + sin2
    return t * t * (z + math.sqrt(z * z + alpha * alpha * (1.0 - z * z)))


@stage
def draw(batch, n, alpha, scratch):
    """Independent numbers for the facets of ``n`` rays."""
    keys = batch[KEY].view(np.uint64)
    cosines, sines, heights, widths = scratch[FACET_X], scratch[FACET_Y], scratch[FACET_Z], scratch[WIDTH]
    ratios = batch[RATIO]
    for i in range(n):
        sines[i], cosines[i] = random_sincos(keys[i], AZIMUTH)
        heights[i] = uniform(keys[i], HEIGHT)
    for i in range(n):
        width = choose_width(alpha, uniform(keys[i], MIXTURE))
        widths[i] = width if ratios[i] < MOST else alpha


@stage
def draw_lattice(numbers, n, alpha, shifts_key, dimension, scratch):
    """As `draw`, from three dimensions of the lattice of all paths, whose first events leave ratios below `MOST`."""
    cosines, sines, heights, widths = scratch[FACET_X], scratch[FACET_Y], scratch[FACET_Z], scratch[WIDTH]
    azimuth = uniform(shifts_key, dimension)
    height = uniform(shifts_key, dimension + 1)
    mixture = uniform(shifts_key, dimension + 2)
    for i in range(n):
        sines[i], cosines[i] = sincos_turns(coordinate(azimuth, numbers[i], STEPS[dimension]))
        heights[i] = coordinate(height, numbers[i], STEPS[dimension + 1])
        widths[i] = choose_width(alpha, coordinate(mixture, numbers[i], STEPS[dimension + 2]))


@stage
def meet_facets(batch, n, alpha, scratch):
    """Turn the numbers drawn into facets, with the cosines at them; multiplies the ratios."""
    _meet(
        batch[X],
        batch[Y],
        batch[Z],
        n,
        alpha,
        scratch[WIDTH],
        scratch[FACET_X],
        scratch[FACET_Y],
        scratch[FACET_Z],
        scratch[COSINE],
        batch[RATIO],
    )


@stage
def _meet(x, y, z, n, alpha, width, fx, fy, fz, cosines, ratios):
    for i in range(n):
        vx = x[i]
        vy = y[i]
        vz = z[i]
        mx, my, mz, ratio = meet_facet(vx, vy, vz, alpha, width[i], fx[i], fy[i], fz[i])
        fx[i] = mx
        fy[i] = my
        fz[i] = mz
        cosines[i] = min(1.0, max(0.0, vx * mx + vy * my + vz * mz))
        ratios[i] *= ratio if ratios[i] < MOST else 1.0
