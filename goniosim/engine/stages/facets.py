"""The microfacets that a batch of rays meets on a rough interface.

Three short loops instead of one long one: the chain of operations in each is short enough for the
processor to work on several iterations at once.
"""

from ..._jit import stage
from ...optics.elementary import sincos_turns
from ...optics.ggx import sample_visible_normal
from ...optics.random import derive_key, uniform
from ..layout import COSINE, FACET_X, FACET_Y, FACET_Z, X, Y, Z

FACET_AZIMUTH, FACET_HEIGHT = 0, 1


@stage
def meet_facets(batch, n, alpha, key, scratch):
    """Sample a visible facet for each of ``n`` rays: its normal and the cosine at it."""
    u_x = scratch[FACET_X]
    u_y = scratch[FACET_Y]
    u_z = scratch[FACET_Z]
    _draw(n, key, u_x, u_y, u_z)
    sample_facets(batch[X], batch[Y], batch[Z], n, alpha, u_x, u_y, u_z, scratch[COSINE])


@stage
def _draw(n, key, cosines, sines, heights):
    azimuth_key = derive_key(key, FACET_AZIMUTH)
    height_key = derive_key(key, FACET_HEIGHT)
    for i in range(n):
        sines[i], cosines[i] = sincos_turns(uniform(azimuth_key, i))
        heights[i] = uniform(height_key, i)


@stage
def sample_facets(x, y, z, n, alpha, fx, fy, fz, cosines):
    """Turn uniform numbers into facets: cosine and sine of an azimuth in ``fx`` and ``fy``, a height in ``fz``."""
    for i in range(n):
        vx = x[i]
        vy = y[i]
        vz = z[i]
        mx, my, mz = sample_visible_normal(vx, vy, vz, alpha, fx[i], fy[i], fz[i])
        fx[i] = mx
        fy[i] = my
        fz[i] = mz
        cosines[i] = min(1.0, max(0.0, vx * mx + vy * my + vz * mz))
