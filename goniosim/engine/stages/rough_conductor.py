"""Rough opaque conductor: GGX facets, Fresnel reflectance per channel, single scattering."""

from ..._jit import stage
from ...optics.ggx import smith_g1
from ..layout import COSINE, FACET_X, FACET_Y, FACET_Z, GAIN, TRANSMITTED, X, Y, Z
from .facets import meet_facets
from .masking import apply_masking
from .smooth_conductor import absorb_in_conductor


@stage
def scatter(batch, n, alpha, spectral, key, scratch, ledger):
    """Scatter ``n`` rays; ``spectral`` holds the relative eta and kappa of every channel."""
    meet_facets(batch, n, alpha, key, scratch)
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
        twice = 2.0 * cosines[i]
        height = twice * fz[i] - z[i]
        x[i] = x[i] - twice * fx[i]
        y[i] = y[i] - twice * fy[i]
        z[i] = height
        gain[i] = smith_g1(height, alpha)
        transmitted[i] = 0.0
