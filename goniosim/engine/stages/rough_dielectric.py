"""Rough dielectric interface: GGX facets, Fresnel coin, single scattering (Walter et al. 2007)."""

from ..._jit import stage
from ...optics.fresnel import fresnel_dielectric
from ...optics.ggx import smith_g1
from ...optics.random import derive_key, uniform
from ..layout import COSINE, FACET_X, FACET_Y, FACET_Z, GAIN, TRANSMITTED, X, Y, Z
from .facets import meet_facets
from .masking import apply_masking
from .smooth_dielectric import COIN


@stage
def scatter(batch, n, alpha, eta, key, scratch, ledger):
    """Scatter ``n`` rays; ``eta`` is the index of the far side relative to the side of arrival."""
    meet_facets(batch, n, alpha, key, scratch)
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
        scratch[COSINE],
        scratch[GAIN],
        scratch[TRANSMITTED],
    )
    apply_masking(batch, n, scratch, ledger)


@stage
def _reflect_or_refract(x, y, z, n, alpha, eta, coin_key, fx, fy, fz, cosines, gain, transmitted):
    inverse_eta = 1.0 / eta
    for i in range(n):
        cosine = cosines[i]
        reflectance, cos_t = fresnel_dielectric(cosine, eta)
        reflect = uniform(coin_key, i) < reflectance
        along_facet = 2.0 * cosine if reflect else cosine * inverse_eta - cos_t
        along_view = 1.0 if reflect else inverse_eta
        height = along_facet * fz[i] - along_view * z[i]
        height = height if reflect else -height
        x[i] = along_view * x[i] - along_facet * fx[i]
        y[i] = along_view * y[i] - along_facet * fy[i]
        z[i] = height
        gain[i] = smith_g1(height, alpha)
        transmitted[i] = 0.0 if reflect else 1.0
