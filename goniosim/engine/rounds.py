"""How a run of replicates grows: rounds of equally many replicates, each twice as large as in the round before.

A round's weight is its size, fixed before it is run: so rounds add up without bias wherever a run stops, and
checkpoints fall on their ends. Growing in size lets a lattice fill its cube; growing in number would not.
"""

# Replicates of a round: their scatter tells a standard error to 13 %, and much better over many cells.
REPLICATES = 32
# Light paths of a replicate of the first round, at least.
SMALLEST = 4096
# Fewer light paths of a direction are not worth the replicates.
FEWEST_PATHS = REPLICATES * SMALLEST
# Less of an interrupted round says nothing of its scatter.
FEWEST_REPLICATES = 8


def sizes(paths, smallest):
    """Sizes of the replicates, round by round, that add up to a number of light paths.

    Parameters
    ----------
    paths : int
        Of one direction, at least.
    smallest : int
        Light paths of a replicate, at least, unless fewer than `FEWEST_PATHS` are asked for.

    Returns
    -------
    list of int
    """
    least = REPLICATES * smallest
    if paths >= FEWEST_PATHS:
        paths = max(paths, least)
    rounds = max(1, (max(paths, 1) // least + 1).bit_length() - 1)
    first = -(-paths // (REPLICATES * ((1 << rounds) - 1)))
    return [first << k for k in range(rounds)]


def chunks(chunk):
    """Numbers of the replicates of a round, in pieces of ``chunk``."""
    return [range(first, min(first + chunk, REPLICATES)) for first in range(0, REPLICATES, chunk)]
