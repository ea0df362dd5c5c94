"""Eq. 6 of Bati, Pacanowski and Barla 2019: the exact first lobe, and Belcour's forward lobes for the rest.

f(l, v) = f_r0(l, v) + sum_{k >= 1} e_k(l.n) D(h; alpha_k) G(l, v; alpha_k) / (4 (l.n) (v.n))
"""

import numpy as np

from ..._jit import kernel
from ...optics.fresnel import fresnel_conductor, fresnel_dielectric
from ...scene import distinct_channels
from ..model import Model, Prepared
from ..stack import (
    DIELECTRIC,
    add_lobe,
    ggx_lobe,
    kernel_alphas,
    light_direction,
    make_stack,
)
from .lobes import Options, prepare_forward, supports_conductor_base
from .lobes import evaluate as evaluate_lobes


@kernel
def evaluate(tables, light, x, y, z, out):
    """Write the BSDF into ``out`` [channel, n]; see `goniosim.models.model.Prepared`."""
    kind, eta, spectral, alpha, rough, lobes = tables
    evaluate_lobes(lobes, light, x, y, z, out)
    if rough:
        n = x.shape[0]
        lobe = np.empty(n)
        cosine = np.empty(n)
        for i in range(n):
            value, facet = ggx_lobe(light[0], light[1], light[2], x[i], y[i], z[i], alpha, lobes[2])
            lobe[i] = value
            cosine[i] = facet
        add_lobe(kind, eta, spectral, lobe, cosine, np.ones(out.shape), out)


@kernel
def _add_mirror_reflectance(kind, eta, spectral, cosine, out):
    for c in range(out.shape[0]):
        if kind == DIELECTRIC:
            reflectance, _ = fresnel_dielectric(cosine, eta)
            out[c] += reflectance
        else:
            out[c] += fresnel_conductor(cosine, spectral[0, c], spectral[1, c])


def _prepare(scene, theta_i_deg, component, options):
    if component == "reflection/internal":
        return prepare_forward(scene, theta_i_deg, component, options)
    inner = prepare_forward(scene, theta_i_deg, "reflection/internal", options)
    lobes, mirror_energy = inner.tables, inner.mirror_energy.copy()
    if component == "reflection/direct":
        lobes = (lobes[0][:0], lobes[1][:0], lobes[2])
        mirror_energy[:] = 0.0
    stack = make_stack(scene.material)
    distinct, position = distinct_channels(scene)
    light = light_direction(theta_i_deg)
    kind, eta = int(stack.kinds[0]), float(stack.index[1] / stack.index[0])
    spectral = np.ascontiguousarray(stack.spectral[0][:, distinct])
    rough = bool(stack.alphas[0] > 0.0)
    if not rough:
        _add_mirror_reflectance(kind, eta, spectral, light[2], mirror_energy)
    alpha = float(kernel_alphas(stack.alphas)[0])
    narrowest = min([alpha] * rough + [inner.narrowest] * len(lobes[1]), default=1.0)
    return Prepared(evaluate, (kind, eta, spectral, alpha, rough, lobes), light, mirror_energy, position, narrowest)


MODEL = Model(
    name="bati19_belcour",
    citation="M. Bati, R. Pacanowski and P. Barla, Comparative study of layered material models, "
    "Workshop on Material Appearance Modeling, 2019, Eq. 6",
    applies_to="reflection off conductor bases, any number of layers",
    options=Options,
    supports=supports_conductor_base,
    prepare=_prepare,
)
