"""What the models after Belcour 2018 share: options, statistics of a scene, and the sum of GGX lobes."""

from dataclasses import dataclass

import numpy as np

from ..._jit import kernel
from ...scene import distinct_channels
from ..model import Prepared
from ..options import masking_option, option
from ..stack import ggx_lobe, kernel_alphas, light_direction, make_stack
from .sweep import sweep


@dataclass(frozen=True)
class Options:
    """Options of the models after Belcour."""

    masking: str = masking_option()
    fgd: str = option(
        ("auto", "exact", "fresnel"),
        "energy of a rough interface: its albedo by quadrature, or plain Fresnel; auto: exact for metals, "
        "fresnel for slabs",
    )
    refraction_scale: str = option(
        ("auto", "paper", "normal"),
        "width of a rough refraction: scaled for the angle as in the paper, or as at normal incidence as in "
        "the published code; auto: normal for metals, paper for slabs",
    )
    jacobian: str = option(
        ("published", "snell"),
        "how variances cross a refraction: as published, or by the derivative of Snell's law for the way "
        "the light goes",
    )
    normalise_lobes: bool = option(
        (False, True), "divide every lobe by its own albedo, so that it carries exactly its energy"
    )


def supports_conductor_base(scene, component):
    """None for the reflection of a stack on a conductor, else one sentence why not."""
    base = scene.material.interfaces[-1]
    if base.type == "lambert":
        return "does not apply to a Lambertian base: its lobes are GGX lobes about the mirror direction"
    if base.type == "dielectric":
        return "applies to conductor bases only: the last interface of this material is a dielectric"
    if component == "transmission":
        return "has no transmission here: the base is an opaque conductor"
    return None


def belcour_tables(material, options):
    """Arguments of `goniosim.models.belcour.sweep.sweep` that describe the material and the options.

    Returns
    -------
    kinds, alphas, etas, spectral, taus : ndarray
    flags : tuple of bool
    """
    stack = make_stack(material)
    metal = not material.transmits
    exact = options.fgd == "exact" or (options.fgd == "auto" and metal)
    normal = options.refraction_scale == "normal" or (options.refraction_scale == "auto" and metal)
    flags = (
        exact,
        normal,
        options.jacobian == "snell",
        options.masking == "correlated",
        options.normalise_lobes,
    )
    etas = stack.index[1:] / stack.index[:-1]
    return stack.kinds, stack.alphas, etas, stack.spectral, stack.taus, flags


def statistics(scene, cosine, options):
    """Energies and widths of all lobes for one cosine at the top interface.

    Parameters
    ----------
    scene : goniosim.scene.Scene
        Without a Lambertian base.
    cosine : float
    options : Options

    Returns
    -------
    energy : ndarray, shape (K, 3)
        Of the lobe of each interface.
    alpha : ndarray, shape (K,)
        GGX width of each lobe; 0 for a Dirac lobe, made by smooth interfaces alone.
    reflection, transmission : ndarray, shape (4,)
        Energies per channel and GGX width of all that is reflected, and of all that is transmitted.
    """
    kinds, alphas, etas, spectral, taus, flags = belcour_tables(scene.material, options)
    energy, alpha, total = np.empty_like(taus), np.empty(len(kinds)), np.empty((2, taus.shape[1] + 1))
    sweep(kinds, alphas, etas, spectral, taus, cosine, flags, energy, alpha, total)
    return energy, alpha, total[0], total[1]


def lobes_of(component):
    """Which lobes make up a component of the reflection: a slice over the interfaces."""
    parts = {"reflection/direct": slice(0, 1), "reflection/internal": slice(1, None)}
    return parts.get(component, slice(None))


def prepare_lobes(scene, options, light, energy, alpha):
    """A sum of lobes about the mirror image of ``light``: GGX lobes, and Dirac lobes where the width is 0.

    Energies [lobe, 3], widths [lobe].
    """
    distinct, position = distinct_channels(scene)
    energy = energy[:, distinct]
    dirac = alpha == 0.0
    widths = kernel_alphas(alpha[~dirac])
    tables = (energy[~dirac], widths, options.masking == "correlated")
    return Prepared(evaluate, tables, light, energy[dirac].sum(axis=0), position, widths.min(initial=1.0))


def prepare_forward(scene, theta_i_deg, component, options):
    """Lobes of the forward sweep that belong to a component, on a conductor base."""
    light = light_direction(theta_i_deg)
    energy, alpha, _, _ = statistics(scene, light[2], options)
    part = lobes_of(component)
    return prepare_lobes(scene, options, light, energy[part], alpha[part])


@kernel
def evaluate(tables, light, x, y, z, out):
    """Sum of lobes e D G / (4 l_z v_z) into ``out``; see `goniosim.models.model.Prepared`."""
    energy, alpha, correlated = tables
    out[:] = 0.0
    n = x.shape[0]
    value = np.empty(n)
    lx = light[0]
    ly = light[1]
    lz = light[2]
    for k in range(alpha.shape[0]):
        width = alpha[k]
        for i in range(n):
            lobe, _ = ggx_lobe(lx, ly, lz, x[i], y[i], z[i], width, correlated)
            value[i] = lobe
        for c in range(out.shape[0]):
            o = out[c]
            e = energy[k, c]
            for i in range(n):
                o[i] += e * value[i]
