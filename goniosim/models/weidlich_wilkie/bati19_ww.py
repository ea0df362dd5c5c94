"""Eq. 5 of Bati, Pacanowski and Barla 2019: Weidlich and Wilkie's model with the Jacobian of refraction.

    f = f_r0(l0, v0) + (1 - F(n.l0)) (1 - F(n.v0)) f_r1(l1, v1; max(alpha0, alpha1)) a (N_0 / N_1)^2,

l1 and v1 refracted about the normal n; no term for total internal reflection.
"""

from dataclasses import dataclass

import numpy as np

from ..._jit import kernel
from ...optics.fresnel import dielectric_transmittance
from ...optics.medium import path_length
from ...optics.refraction import refracted_cosine
from ..model import Model
from ..options import masking_option
from ..stack import add_lobe, ggx_lobe
from .family import (
    BELOW,
    FACE,
    conductor_index_option,
    descend,
    prepare,
    running_ratios,
    supports,
)


@dataclass(frozen=True)
class Options:
    """Options of ``bati19_ww``."""

    masking: str = masking_option()
    conductor_index: str = conductor_index_option()


@kernel
def evaluate(tables, light, x, y, z, out):
    """Write the BSDF into ``out`` [channel, n]; see `goniosim.models.model.Prepared`."""
    n = x.shape[0]
    lobe = np.empty(n)
    cosine = np.empty(n)
    through = np.empty(n)
    path = np.empty(n)
    weight = np.ones(out.shape)
    out[:] = 0.0
    for k in range(tables.kinds.shape[0]):
        _cross(k, tables, light, x, y, z, lobe, cosine, through, path)
        if tables.counted[k]:
            add_lobe(tables.kinds[k], tables.etas[k], tables.spectral[k], lobe, cosine, weight, out)
        descend(through, path, tables.taus[k], weight)


@kernel
def _cross(k, tables, light, x, y, z, lobe, cosine, through, path):
    eta = tables.etas[k]
    alpha = tables.alphas[k]
    unit = tables.unit[k]
    correlated = tables.correlated
    above = tables.ratios[FACE, k]
    below = tables.ratios[BELOW, k]
    lx = above * light[0]
    ly = above * light[1]
    lz = refracted_cosine(light[2], above)
    l1 = refracted_cosine(light[2], below)
    # J = (N_k / N_{k+1})^2, Appendix C of Bati et al.
    jacobian = 1.0 / (eta * eta)
    through_l = dielectric_transmittance(lz, eta)
    for i in range(x.shape[0]):
        vz = refracted_cosine(z[i], above)
        value, facet = ggx_lobe(lx, ly, lz, above * x[i], above * y[i], vz, alpha, correlated)
        lobe[i] = unit if unit > 0.0 else value
        cosine[i] = facet

        v1 = refracted_cosine(z[i], below)
        possible = (l1 > 0.0) & (v1 > 0.0)
        through[i] = through_l * dielectric_transmittance(vz, eta) * jacobian if possible else 0.0
        path[i] = path_length(l1) + path_length(v1)


def _prepare(scene, theta_i_deg, component, options):
    return prepare(evaluate, scene, theta_i_deg, component, options, widened=True, ratios=running_ratios)


MODEL = Model(
    name="bati19_ww",
    citation="M. Bati, R. Pacanowski and P. Barla, Comparative study of layered material models, "
    "Workshop on Material Appearance Modeling, 2019, Eq. 5",
    applies_to="reflection off opaque bases (Lambertian, conductor), any number of layers",
    options=Options,
    supports=supports,
    prepare=_prepare,
)
