"""How many facets an arrival at a way out deserves: as many as cells see what leaves through them, up to a limit."""

import math

import numpy as np

from ...slices import PARAMETRIZATIONS
from ..layout import UP

# More facets cost more than they tell, since other paths would arrive from elsewhere.
MOST_FACETS = 32
# Light that comes by again is faint: so many times fewer facets, that its deposits are like those of others.
FEWER_LATER = 8


def facets_per_arrival(plan, direction, way):
    """Facets through which a ray leaves at the interface of a way out.

    Parameters
    ----------
    plan : goniosim.engine.plan.Plan
    direction : int
    way : int
        UP or DOWN.
    """
    # The index inside over that outside: a facet that is tilted by an angle turns what leaves by (n - 1) times that.
    n = plan.etas[0] if way == UP else 1.0 / plan.etas[-1]
    width = plan.alphas[0 if way == UP else -1] * abs(n - 1.0)
    return int(np.clip(_cells_within(plan, direction, width), 1, MOST_FACETS))


def _cells_within(plan, direction, width):
    """Cells around the mirror direction that a lobe of half-width ``width`` covers, roughly."""
    sine, _, cosine = plan.light[direction]
    along = np.array([-cosine, 0.0, -sine])
    across = np.array([0.0, 1.0, 0.0])
    views = np.array([-sine, 0.0, cosine]) + width * np.stack([along, -along, across, -across])
    views /= np.linalg.norm(views, axis=1, keepdims=True)
    u, psi = PARAMETRIZATIONS[plan.parametrization_name][1].coordinates(views, plan.light[direction])
    rows = max(1.0, np.ptp(u) * plan.rows / (0.5 * math.pi))
    columns = max(1.0, np.ptp(psi) * plan.columns / (2.0 * math.pi))
    return rows * columns if width > 0.0 else 1.0
