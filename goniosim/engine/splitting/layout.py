"""Where things lie in the tables of the split walk; batches are those of `goniosim.engine.layout`.

Behind the weights (and the order) a ray carries the ratio of densities by which its facets were not drawn alike (see
`numbers.far_facet`), and the number of its path, which is its place in the lattices: rows `RATIO` and `PATH`.
"""

# Rows of a batch, from its end.
RATIO, PATH = -2, -1

# What a ray has met since it entered, and so which numbers it has drawn: nothing of the last interface; the last
# interface, and not the top since; both.
FRESH, BASED, LATER = 0, 1, 2
PHASES = 3

# First dimension of the lattice for the facet of entry, the first event on the last interface, and the first exit on
# top after that. What a path may meet again takes hashed numbers.
ENTRY, BASE, EXIT = 0, 2, 4
HASHED = -1

# Rows of scratch of a batch.
POINT_U, POINT_V = 0, 1  # numbers that each ray has drawn, from which those of all its exits follow
FACET_X, FACET_Y, FACET_Z, COSINE = 2, 3, 4, 5  # normal of the microfacet, and the cosine at it
REFLECTANCE, COSINE_BEYOND = 6, 7  # at the microfacet
FACET_RATIO = 8  # of the density of the microfacet to that it was drawn from
# The refracted ray, as the next interface views it; if it leaves, what is deposited of the ray's weights.
THROUGH_X, THROUGH_Y, THROUGH_Z, AMOUNT, THROUGH_GAIN = 9, 10, 11, 12, 13
BACK_X, BACK_Y, BACK_Z, BACK_GAIN = 14, 15, 16, 17  # the reflected ray
RADIUS, TURN = 18, 19  # what azimuths of one exit share
N_SCRATCH = 20

# Entries of the integer state of a replicate.
LEFT = 0  # paths not yet started
LAUNCHED = 1  # paths started so far
STAGES = 2  # stages run so far: the counter of the random numbers
ROUNDS = 3  # stages run since the last path was started
EVENTS = 4  # facets met, and what costs as much
N_STATE = 5
