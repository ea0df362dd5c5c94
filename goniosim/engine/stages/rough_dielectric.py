"""Rough dielectric interface: GGX facets, Fresnel coin, single scattering (Walter et al. 2007)."""

from ..._jit import stage
from ...optics.fresnel import reflects
from ...optics.ggx import smith_g1_scaled
from ...optics.random import derive_key, uniform
from ..layout import FACET_X, FACET_Y, FACET_Z, GAIN, TRANSMITTED, X, Y, Z
from .facets import sample_facets
from .masking import apply_masking
from .smooth_dielectric import COIN


@stage
def scatter(batch, n, alpha, eta, key, scratch, ledger):
    """Scatter ``n`` rays; ``eta`` is the index of the far side relative to the side of arrival."""
    sample_facets(batch, n, alpha, key, scratch)
    _reflect_or_refract(
        batch[X],
        batch[Y],
        batch[Z],
        n,
        alpha,
        eta,
        derive_key(key, COIN),
        scratch[FACET_X],
        scratch[FACET_Y],
        scratch[FACET_Z],
        scratch[GAIN],
        scratch[TRANSMITTED],
    )
    apply_masking(batch, n, scratch, ledger)


@stage
def _reflect_or_refract(x, y, z, n, alpha, eta, coin_key, fx, fy, fz, gain, transmitted):
    inverse_eta = 1.0 / eta
    for i in range(n):
        square = fx[i] * fx[i] + fy[i] * fy[i] + fz[i] * fz[i]
        cosine = max(0.0, x[i] * fx[i] + y[i] * fy[i] + z[i] * fz[i])
        reflect, g = reflects(uniform(coin_key, i), cosine, square, eta)
        along_facet = 2.0 * cosine if reflect else (cosine - g) * inverse_eta
        along_view = square if reflect else inverse_eta * square
        # The new direction times the square.
        height = along_facet * fz[i] - along_view * z[i]
        height = height if reflect else -height
        g1, inverse = smith_g1_scaled(height, square, alpha)
        x[i] = (along_view * x[i] - along_facet * fx[i]) * inverse
        y[i] = (along_view * y[i] - along_facet * fy[i]) * inverse
        z[i] = height * inverse
        gain[i] = g1
        transmitted[i] = 0.0 if reflect else 1.0
