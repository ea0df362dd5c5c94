"""Elek 2010: a variant of Weidlich and Wilkie that evaluates the base in the refracted directions.

f = f_r0(l0, v0) + (1 - F) f_r1(l1, v1; max(alpha0, alpha1)) a [(1 - G) + (1 - F) G],
F = F(l0.h0),  G = G(l0, v0),  l1 and v1 refracted about the normal n.
"""

from dataclasses import dataclass

import numpy as np

from ..._jit import kernel
from ...optics.fresnel import dielectric_transmittance
from ...optics.ggx import smith_g1
from ...optics.masking import height_correlation
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
    t_masking_option,
    t_roughness_option,
)


@dataclass(frozen=True)
class Options:
    """Options of ``elek10``."""

    masking: str = masking_option()
    conductor_index: str = conductor_index_option()
    t_roughness: str = t_roughness_option()
    t_masking: str = t_masking_option()


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
    t_alpha = tables.t_alphas[k]
    unit = tables.unit[k]
    correlated = tables.correlated
    vgroove = tables.vgroove
    above = tables.ratios[FACE, k]
    below = tables.ratios[BELOW, k]
    lx = above * light[0]
    ly = above * light[1]
    lz = refracted_cosine(light[2], above)
    l1 = refracted_cosine(light[2], below)
    for i in range(x.shape[0]):
        vz = refracted_cosine(z[i], above)
        value, facet = ggx_lobe(lx, ly, lz, above * x[i], above * y[i], vz, alpha, correlated)
        lobe[i] = unit if unit > 0.0 else value
        cosine[i] = facet

        through_facet = dielectric_transmittance(facet, eta)
        g_l = smith_g1(lz, t_alpha)
        g_v = smith_g1(vz, t_alpha)
        smith = g_l * g_v * height_correlation(g_l, g_v, correlated)
        # |l + v| = 2 l.h for unit vectors
        hz = (lz + vz) / max(2.0 * facet, 1e-300)
        g = min(1.0, 2.0 * hz * min(lz, vz) / max(facet, 1e-300)) if vgroove else smith
        t = (1.0 - g) + through_facet * g
        v1 = refracted_cosine(z[i], below)
        possible = (l1 > 0.0) & (v1 > 0.0)
        through[i] = through_facet * t if possible else 0.0
        path[i] = path_length(l1) + path_length(v1)


def _prepare(scene, theta_i_deg, component, options):
    return prepare(evaluate, scene, theta_i_deg, component, options, widened=True, ratios=running_ratios)


MODEL = Model(
    name="elek10",
    citation="O. Elek, Layered materials in real-time rendering, CESCG 2010",
    applies_to="reflection off opaque bases (Lambertian, conductor), any number of layers",
    options=Options,
    supports=supports,
    prepare=_prepare,
)
