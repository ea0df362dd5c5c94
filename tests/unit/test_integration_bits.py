"""What is integrated has the same bits on any number of threads, wherever their arrays lie in memory."""

import numpy as np

from goniosim.engine.direct import direct_reflection
from goniosim.engine.plan import make_plan
from goniosim.integration import Pool
from reference.scenes import dielectric, lambert, make_scene

TIMES = 60


def test_errors_of_integrals_do_not_depend_on_where_threads_keep_their_arrays():
    """Threads have heaps of their own: in up to a quarter of the runs a stated error was another, by a fifth."""
    plan = make_plan(make_scene([dielectric(1.5, 0.2), lambert(0.5)], [0, 45], rows=12, columns=24))

    def integrated(threads):
        with Pool(threads) as pool:
            return np.array([direct_reflection(plan, direction, pool) for direction in range(2)])

    first = integrated(1)
    assert sum(not np.array_equal(integrated(7), first) for _ in range(TIMES)) == 0
