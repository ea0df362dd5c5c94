"""Rough opaque conductor: GGX facets, Fresnel reflectance per channel, single scattering."""

import math

from ..._jit import stage
from ...optics.ggx import smith_g1_scaled
from ..layout import COSINE, FACET_X, FACET_Y, FACET_Z, GAIN, TRANSMITTED, X, Y, Z
from .facets import sample_facets
from .masking import apply_masking
from .smooth_conductor import absorb_in_conductor


@stage
def scatter(batch, n, alpha, spectral, key, scratch, ledger):
    """Scatter ``n`` rays; ``spectral`` holds the relative eta and kappa of every channel."""
    sample_facets(batch, n, alpha, key, scratch)
    _reflect(
        batch[X],
        batch[Y],
        batch[Z],
        n,
        alpha,
        scratch[FACET_X],
        scratch[FACET_Y],
        scratch[FACET_Z],
        scratch[COSINE],
        scratch[GAIN],
        scratch[TRANSMITTED],
    )
    absorb_in_conductor(batch, n, spectral, scratch[COSINE], ledger)
    apply_masking(batch, n, scratch, ledger)


@stage
def _reflect(x, y, z, n, alpha, fx, fy, fz, cosines, gain, transmitted):
    for i in range(n):
        square = fx[i] * fx[i] + fy[i] * fy[i] + fz[i] * fz[i]
        length = math.sqrt(square)
        cosine = max(0.0, x[i] * fx[i] + y[i] * fy[i] + z[i] * fz[i])
        twice = 2.0 * cosine
        # The new direction times the square.
        height = twice * fz[i] - square * z[i]
        g1, inverse = smith_g1_scaled(height, square, alpha)
        x[i] = (square * x[i] - twice * fx[i]) * inverse
        y[i] = (square * y[i] - twice * fy[i]) * inverse
        z[i] = height * inverse
        cosines[i] = min(1.0, cosine * length * inverse)
        gain[i] = g1
        transmitted[i] = 0.0
