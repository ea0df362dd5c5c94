"""The microfacets that a batch of rays meets on a rough interface.

Short loops instead of one long one: the chain of operations in each is short enough for the
processor to work on several iterations at once. Square roots and divisions are what takes time there: normals
keep the length at which they are found, which spares most of them.
"""

from ..._jit import stage
from ...optics.ggx import sample_visible_facet
from ...optics.random import derive_key, random_sincos, uniform
from ..layout import FACET_X, FACET_Y, FACET_Z, X, Y, Z

FACET_AZIMUTH, FACET_HEIGHT = 0, 1


@stage
def sample_facets(batch, n, alpha, key, scratch):
    """Sample a visible facet for each of ``n`` rays: its normal, of any length."""
    u_x = scratch[FACET_X]
    u_y = scratch[FACET_Y]
    u_z = scratch[FACET_Z]
    _draw(n, key, u_x, u_y, u_z)
    _sample(batch[X], batch[Y], batch[Z], n, alpha, u_x, u_y, u_z)


@stage
def _draw(n, key, cosines, sines, heights):
    azimuth_key = derive_key(key, FACET_AZIMUTH)
    height_key = derive_key(key, FACET_HEIGHT)
    for i in range(n):
        sines[i], cosines[i] = random_sincos(azimuth_key, i)
        heights[i] = uniform(height_key, i)


@stage
def _sample(x, y, z, n, alpha, fx, fy, fz):
    for i in range(n):
        fx[i], fy[i], fz[i] = sample_visible_facet(x[i], y[i], z[i], alpha, fx[i], fy[i], fz[i])
