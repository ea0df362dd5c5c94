"""Where things lie in the tables that the compiled engine shares with its driver.

A *batch* is a two-dimensional array ``[field, ray]``: the unit vector from the interface back to
where the ray came from (its view of the interface, z > 0 on the side it arrives from), one
weight per distinct channel, and, if orders are asked for, the number of events on the top
interface so far.
"""

# The two ways out of the stack.
UP, DOWN = 0, 1

# Fields of a batch.
X, Y, Z, WEIGHT = 0, 1, 2, 3

# Rows of the scratch array of a stage: what an interface did to each ray.
GAIN = 0  # factor on all weights: the masking G1 of the new direction, 0 for a ray that ended
TRANSMITTED = 1  # 1 if the ray went through the interface, 0 if it was reflected
BOOST = 2  # factor of Russian roulette: 0 for a loser
COSINE = 3  # cosine at the microfacet
FACET_X, FACET_Y, FACET_Z = 4, 5, 6  # normal of the microfacet
N_SCRATCH = 7

# Rows of the ledger, in the order of goniosim.result.AUDIT_ENTRIES.
REFLECTED_DIRECT = 0
REFLECTED_INTERNAL = 1
TRANSMITTED_OUT = 2
ABSORBED_MEDIA = 3
ABSORBED_BASE = 4
LOST_REFLECTION = 5
LOST_TRANSMISSION = 6
LOST_ROULETTE = 7
LOST_CAP = 8
N_LEDGER = 9

# Entries of the integer state of a part of a work unit.
LEFT = 0  # rays not yet launched
STAGES = 1  # stages run so far: the counter of the random numbers
ROUNDS = 2  # stages run since the last ray was launched
EVENTS = 3  # ray-interface events so far
N_STATE = 4
