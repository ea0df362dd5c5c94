"""What the variants of the Weidlich-Wilkie model share (Weidlich and Wilkie 2007; Eq. 2 of Bati et al. 2019).

    f(l0, v0) = f_r0 + T f_r1 a t,    a = exp(-tau (1 / |n.l1| + 1 / |n.v1|)),

applied again to f_r1 for every further layer: from the top down, each interface adds its lobe
times the weight of all crossings above it. A variant is one kernel ``evaluate`` in its own file,
which chooses the directions, the transmissivity and t.
"""

from typing import NamedTuple

import numpy as np

from ..._jit import kernel
from ...optics.medium import transmittance
from ...scene import distinct_channels
from ..model import Prepared
from ..options import option
from ..stack import LAMBERT, kernel_alphas, light_direction, make_stack

# Rows of Tables.ratios: index of the outside over that of the medium in which ...
LOBE = 0  # ... the lobe of the interface is evaluated,
FACE = 1  # ... light arrives at the interface,
BELOW = 2  # ... light goes on after crossing it.


class Tables(NamedTuple):
    """What the kernels of the family read: K interfaces, D distinct channels."""

    kinds: np.ndarray  # (K,)
    etas: np.ndarray  # (K,) index below over above
    spectral: np.ndarray  # (K, 2, D)
    taus: np.ndarray  # (K, D)
    alphas: np.ndarray  # (K,) of the lobes
    t_alphas: np.ndarray  # (K,) in the G of t
    ratios: np.ndarray  # (3, K)
    counted: np.ndarray  # (K,) bool: whether the lobe is added
    unit: np.ndarray  # (K,) value that replaces the lobe, 0 where it is evaluated
    correlated: bool
    vgroove: bool


def conductor_index_option():
    """What the index of a conductor in the scene means in the Weidlich-Wilkie family."""
    return option(
        ("relative", "absolute"),
        "index of a conductor: relative to the medium above it, or as it stands in the scene",
    )


def t_roughness_option():
    """Which interface gives the GGX width to the G of the term for total internal reflection."""
    return option(("outer", "inner"), "GGX width in the G of t: that of the upper or of the lower interface")


def t_masking_option():
    """Form of the G of the term for total internal reflection."""
    return option(("smith", "vgroove"), "form of the G of t: that of the lobes, or V-grooves of 1967")


def supports(scene, component):
    """None if the family applies, else one sentence why not."""
    if scene.material.transmits:
        return "applies to opaque bases only: the last interface of this material is a dielectric"
    if component == "transmission":
        return "has no transmission: it describes light that comes back from an opaque base"
    return None


def prepare(kernel, scene, theta_i_deg, component, options, *, widened, ratios):
    """Lower a scene for one incident direction.

    Parameters
    ----------
    kernel : callable
        The variant's ``evaluate``.
    scene : goniosim.scene.Scene
    theta_i_deg : float
    component : str
    options : dataclass
        Of the variant.
    widened : bool
        Whether every interface takes at least the roughness of those above it (Elek 2010).
    ratios : callable
        Indices of all media to the table `Tables.ratios`.

    Returns
    -------
    goniosim.models.model.Prepared
    """
    stack = make_stack(scene.material, options.conductor_index)
    distinct, position = distinct_channels(scene)
    alphas = np.maximum.accumulate(stack.alphas) if widened else stack.alphas
    lambert = stack.kinds == LAMBERT
    asked = np.ones(len(alphas), dtype=bool)
    if component == "reflection/direct":
        asked[1:] = False
    elif component == "reflection/internal":
        asked[0] = False
    t_alphas = alphas.copy()
    if getattr(options, "t_roughness", "outer") == "inner":
        # A Lambertian base has no roughness of its own to offer.
        t_alphas[:-1] = np.where(lambert[1:], alphas[:-1], alphas[1:])
    rough = lambert | (alphas > 0.0)
    tables = Tables(
        kinds=stack.kinds,
        etas=stack.index[1:] / stack.index[:-1],
        spectral=np.ascontiguousarray(stack.spectral[:, :, distinct]),
        taus=np.ascontiguousarray(stack.taus[:, distinct]),
        alphas=kernel_alphas(alphas),
        t_alphas=kernel_alphas(t_alphas),
        ratios=np.ascontiguousarray(ratios(stack.index)),
        counted=asked & rough,
        unit=np.zeros(len(alphas)),
        correlated=options.masking == "correlated",
        vgroove=getattr(options, "t_masking", "smith") == "vgroove",
    )
    light = light_direction(theta_i_deg)
    # A smooth interface adds F delta / cos about the mirror direction in its own medium, where a solid
    # angle is smaller by the squared ratio of the indices.
    spread = tables.ratios[LOBE] ** -2.0
    mirror_energy = np.zeros((len(distinct), 1))
    if not rough[asked].all():
        only_smooth = tables._replace(counted=asked & ~rough, unit=spread)
        x, y, z = (np.array([w]) for w in (-light[0], -light[1], light[2]))
        kernel(only_smooth, light, x, y, z, mirror_energy)
    # Seen from outside, a lobe inside a thinner medium is narrower.
    widths = tables.alphas * np.minimum(1.0, 1.0 / tables.ratios[LOBE])
    narrowest = widths[tables.counted & ~lambert].min(initial=1.0)
    return Prepared(kernel, tables, light, mirror_energy[:, 0], position, narrowest)


def running_ratios(index):
    """Ratios of a variant in which every lobe sees the directions in its own medium."""
    above, below = index[0] / index[:-1], index[0] / index[1:]
    return np.stack([above, above, below])


@kernel
def descend(through, path, tau, weight):
    """Multiply weights [channel, n] by what one crossing and one medium let through."""
    for c in range(weight.shape[0]):
        w = weight[c]
        t = tau[c]
        for i in range(through.shape[0]):
            w[i] *= through[i] * transmittance(t, path[i])
