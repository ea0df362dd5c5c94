"""Facets that split rays meet: unit normals with their cosines, each of which serves both branches."""

from ..._jit import stage
from ...optics.ggx import sample_visible_normal


@stage
def draw_facets(x, y, z, n, alpha, fx, fy, fz, cosines):
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
