"""Facets for a walk that must meet the rare ones too: a defensive mixture of visible normals of three widths.

Rare facets carry the dim tails of wide exits. A tenth of all facets is drawn from wider distributions; the ratio of the
densities is kept apart from the weight, for a roulette that looked at the product would end the very rays drawn for the
tails.
"""

import math

from ..._jit import scalar
from ...optics.elementary import sincos_turns
from ...optics.ggx import ggx_density, sample_visible_normal, smith_g1

# Share of each of the two wider distributions, whose widths are sqrt(alpha) and WIDEST.
SHARE = 0.05
WIDEST = 0.5


@scalar
def meet_facet(x, y, z, alpha, u1, u2, u3):
    """A facet as seen from (x, y, z), and the ratio of the density of width ``alpha`` to that it was drawn from.

    A smooth interface has one facet.
    """
    share = SHARE if alpha > 0.0 else 0.0
    medium = math.sqrt(alpha)
    width = medium if u3 < share else (WIDEST if u3 < 2.0 * share else alpha)
    sine, cosine = sincos_turns(u1)
    mx, my, mz = sample_visible_normal(x, y, z, width, cosine, sine, u2)
    sin2 = mx * mx + my * my
    # Densities of visible normals, but for the factor that they share.
    plain = ggx_density(sin2, mz, alpha) * smith_g1(z, alpha)
    wider = ggx_density(sin2, mz, medium) * smith_g1(z, medium) + ggx_density(sin2, mz, WIDEST) * smith_g1(z, WIDEST)
    ratio = plain / ((1.0 - 2.0 * share) * plain + share * wider) if share > 0.0 else 1.0
    return mx, my, mz, ratio
