"""Weidlich and Wilkie 2009, as published.

    f = f_r0(l0, v0) + (1 - F) f_r1(l0, v0) a [(1 - G) + (1 - F) G],
    F = F(l0.h0),  G = G(l1, v1),  l1 and v1 refracted about the half vector h0.

The base lobe is evaluated in the directions *outside*: a slip of the authors that was published and
is kept (footnote 2 of Bati et al. 2019).
"""

import math
from dataclasses import dataclass

import numpy as np

from ..._jit import kernel
from ...optics.fresnel import dielectric_transmittance
from ...optics.ggx import smith_g1
from ...optics.masking import height_correlation
from ...optics.medium import path_length
from ...optics.refraction import refracted_cosine, refraction_shift
from ..model import Model
from ..options import masking_option, option
from ..stack import add_lobe, ggx_lobe
from .family import (
    BELOW,
    FACE,
    LOBE,
    conductor_index_option,
    descend,
    prepare,
    supports,
    t_masking_option,
    t_roughness_option,
)


@dataclass(frozen=True)
class Options:
    """Options of ``ww09``."""

    masking: str = masking_option()
    conductor_index: str = conductor_index_option()
    t_roughness: str = t_roughness_option()
    t_masking: str = t_masking_option()
    ww_recursion: str = option(
        ("literal", "running"),
        "more than two layers: start every layer from the directions outside, or let them run on",
    )


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
    lx = light[0]
    ly = light[1]
    lz = light[2]
    eta = tables.etas[k]
    alpha = tables.alphas[k]
    t_alpha = tables.t_alphas[k]
    unit = tables.unit[k]
    correlated = tables.correlated
    vgroove = tables.vgroove
    to_lobe = tables.ratios[LOBE, k]
    to_face = tables.ratios[FACE, k]
    to_below = tables.ratios[BELOW, k]
    for i in range(x.shape[0]):
        hx = lx + x[i]
        hy = ly + y[i]
        hz = lz + z[i]
        square = hx * hx + hy * hy + hz * hz
        inverse = 1.0 / math.sqrt(square)
        hx *= inverse
        hy *= inverse
        hz *= inverse
        # l.h = |l + v| / 2 of unit vectors
        c = min(1.0, 0.5 * square * inverse)

        shift = refraction_shift(c, to_lobe, refracted_cosine(c, to_lobe))
        value, facet = ggx_lobe(
            to_lobe * lx + shift * hx,
            to_lobe * ly + shift * hy,
            to_lobe * lz + shift * hz,
            to_lobe * x[i] + shift * hx,
            to_lobe * y[i] + shift * hy,
            to_lobe * z[i] + shift * hz,
            alpha,
            correlated,
        )
        lobe[i] = unit if unit > 0.0 else value
        cosine[i] = facet

        through_facet = dielectric_transmittance(refracted_cosine(c, to_face), eta)
        inside = refracted_cosine(c, to_below)
        shift = refraction_shift(c, to_below, inside)
        l1 = to_below * lz + shift * hz
        v1 = to_below * z[i] + shift * hz
        g_l = smith_g1(l1, t_alpha)
        g_v = smith_g1(v1, t_alpha)
        smith = g_l * g_v * height_correlation(g_l, g_v, correlated)
        g = min(1.0, 2.0 * hz * min(l1, v1) / max(inside, 1e-300)) if vgroove else smith
        t = (1.0 - g) + through_facet * g
        possible = (inside > 0.0) & (l1 > 0.0) & (v1 > 0.0)
        through[i] = through_facet * t if possible else 0.0
        path[i] = path_length(l1) + path_length(v1)


def _literal_ratios(index):
    outside = np.ones(len(index) - 1)
    return np.stack([outside, outside, index[:-1] / index[1:]])


def _running_ratios(index):
    above = index[0] / index[:-1]
    # Each lobe keeps to the directions above the interface over it, as the base of two layers does.
    return np.stack([np.append(1.0, above[:-1]), above, index[0] / index[1:]])


def _prepare(scene, theta_i_deg, component, options):
    ratios = _running_ratios if options.ww_recursion == "running" else _literal_ratios
    return prepare(evaluate, scene, theta_i_deg, component, options, widened=False, ratios=ratios)


MODEL = Model(
    name="ww09",
    citation="A. Weidlich and A. Wilkie, Exploring the potential of layered BRDF models, "
    "SIGGRAPH Asia courses, 2009 (after their Arbitrarily layered micro-facet surfaces, GRAPHITE 2007)",
    applies_to="reflection off opaque bases (Lambertian, conductor), any number of layers",
    options=Options,
    supports=supports,
    prepare=_prepare,
)
