"""Belcour 2018, forward variant: one GGX lobe for each interface, from statistics at the angle of incidence.

    f(l, v) = sum_k e_k(l.n) D(h; alpha_k) G(l, v; alpha_k) / (4 (l.n) (v.n)),  alpha_k = alpha_k(l.n)

A slab has two lobes instead, from the accumulated statistics (the published plug-in for slabs): all
reflection, and all transmission about the refracted direction.
"""

import numpy as np

from ..._jit import kernel
from ...optics.refraction import refracted_cosine
from ...scene import optical_stack
from ..model import Model
from ..stack import light_direction
from .albedo import WHITE, directional_albedo
from .lobes import (
    Options,
    prepare_forward,
    prepare_lobes,
    statistics,
    supports_conductor_base,
)


def _supports(scene, component):
    if not scene.material.transmits:
        return supports_conductor_base(scene, component)
    if component in ("reflection/direct", "reflection/internal"):
        return "merges all reflection of a slab into one lobe: ask for reflection or transmission"
    return None


def _prepare(scene, theta_i_deg, component, options):
    if not scene.material.transmits:
        return prepare_forward(scene, theta_i_deg, component, options)
    light = light_direction(theta_i_deg)
    _, _, reflection, transmission = statistics(scene, light[2], options)
    lobe = reflection
    if component == "transmission":
        lobe = transmission
        light = _refracted_light(light, 1.0 / optical_stack(scene.material).material.interfaces[-1].eta)
    energy, alpha = lobe[:-1], lobe[-1]
    if options.normalise_lobes:
        energy = energy / directional_albedo(WHITE, light[2], alpha, 1.0, 0.0, options.masking == "correlated")
    return prepare_lobes(scene, options, light, energy[None], np.array([alpha]))


@kernel
def _cosine_below(cosine, ratio):
    return refracted_cosine(cosine, ratio)


def _refracted_light(light, ratio):
    """The direction whose mirror image is the light refracted into the last medium.

    Under total reflection there is none: the energy of the lobe is zero and the direction does not matter.
    """
    below = _cosine_below(light[2], ratio)
    return np.array([ratio * light[0], ratio * light[1], below]) if below > 0.0 else light


MODEL = Model(
    name="belcour18_forward",
    citation="L. Belcour, Efficient rendering of layered materials using an atomic decomposition with "
    "statistical operators, ACM TOG 37(4), 2018",
    applies_to="reflection off conductor bases; reflection and transmission of slabs; any number of layers",
    options=Options,
    supports=_supports,
    prepare=_prepare,
)
