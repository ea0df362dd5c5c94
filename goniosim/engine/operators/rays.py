"""Where things lie in the tables of the walk to an interface, and the arrays that hold them."""

import numpy as np

from ..sorting import LANES
from ..tally import aligned
from ..unit import BATCH, queue_capacity

# A ray: its view of the interface, the ratio of densities, the key of its random numbers, the slice of the bins that
# it belongs to, and its weights.
X, Y, Z, RATIO, KEY, SLOT, WEIGHT = range(7)

LEAST_COSINE = 1e-9

# Rows of scratch of a batch.
FACET_X, FACET_Y, FACET_Z, COSINE, WIDTH = range(5)  # the microfacet, and the width of the distribution it is from
REFLECTANCE, COSINE_BEYOND, BRIGHTEST = 5, 6, 7  # at the microfacet; the largest weight of a ray
NEXT_X, NEXT_Y, NEXT_Z, GAIN, NEXT_KEY, MOVED = range(8, 14)  # the ray that goes on, and what of it is moved next
PATH, FRACTION = 8, 9  # before that: its way through a medium, and what is left of it
POLAR, AROUND = 0, 4  # or weights of the nodes that it is spread over, four and four
N_SCRATCH = 14

# Entries of the integer state of a walk.
REPLICATE = 0  # whose paths are started
LAUNCHED = 1  # how many of them have been
EVENTS = 2  # ray-interface events so far
ROUNDS = 3  # stages run since the last path was started
N_STATE = 4

# Batches in the fullest queue, above which a coin with fair weights chooses one branch. From there on no event adds
# rays, so that this, and what `unit.queue_capacity` says of such traffic, is all that a queue must hold.
CROWD = 3


def shapes(plan):
    """Shapes of the arrays of float64, by name."""
    queues, fields = 2 * len(plan.kinds), WEIGHT + plan.n_distinct
    # Not 512 numbers from row to row: in the nearest cache they would all claim the same few places.
    return {
        "queues": (queues, fields, queue_capacity(queues) + CROWD * BATCH),
        "batch": (fields, BATCH + LANES),
        "scratch": (N_SCRATCH, BATCH + LANES),
    }


def workspace(plan):
    """What `arrivals.bin_arrivals` needs besides bins: state, rays in each queue, and the arrays of `shapes`.

    Behind them places: steps and lists of `sorting.sort`, and the first nodes of stencils.
    """
    arrays = [aligned(shape) for shape in shapes(plan).values()]
    filled = np.zeros(2 * len(plan.kinds), np.int64)
    steps, lists, nodes = np.empty(BATCH, np.uint64), np.empty((2, BATCH), np.uint32), np.empty((2, BATCH), np.int64)
    return np.zeros(N_STATE, np.int64), filled, *arrays, steps, lists, nodes
