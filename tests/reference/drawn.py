"""Every draw of small walks of all kinds, as JSON: for each walk its key, and the places, keys and counters."""

import json
import sys
import threading
from functools import partial

import numpy as np

from reference.draws import DRAWN  # first: from here on compiled code is plain

# isort: split
from goniosim.engine.estimators import ESTIMATORS
from goniosim.engine.layout import DOWN, UP
from goniosim.engine.operators import rays
from goniosim.engine.plan import make_plan
from goniosim.engine.splitting.layout import PHASES
from goniosim.engine.unit import Tally, Workspace
from reference.scenes import conductor, dielectric, lambert, make_scene, medium

ROUGH, SMOOTH, NARROW = dielectric(1.5, 0.3), dielectric(1.3), dielectric(1.5, 0.001)
BASE = conductor(1.45, 1.0, 0.3)
# Dark enough for roulette.
STACK = [ROUGH, medium(0.5), SMOOTH, medium(3.0), dielectric(1.6, 0.2), medium(1.0), lambert([0.5, 0.1, 0.1])]
PLASTIC = [ROUGH, medium([0.5, 1.0, 1.0]), lambert(0.8)]
SLAB = [ROUGH, medium(2.0), dielectric(1.0, 0.01)]

# The key of each walk.
KEY = np.uint64(0x123456789ABCDEF)


def _plan(layers):
    return make_plan(make_scene(layers, 40, "half", rows=2, columns=4))


def _analog(layers, count):
    plan = _plan(layers)
    workspace = Workspace(plan, np.full((1, 2 * len(plan.kinds), plan.n_distinct), 0.2))
    DRAWN.clear()
    workspace.run(0, count, KEY, Tally(plan), threading.Event())


def _replicate(name, layers, side, count):
    estimator = ESTIMATORS[name].tiny(_plan(layers), (side,))
    few = estimator.plan
    if name == "split":
        estimator.scales = np.full((1, PHASES * 2 * len(few.kinds), few.n_distinct), 5.0)
    else:
        estimator.prepare()
    workspace = estimator.workspace()
    if name == "split":
        workspace.effort.crowds[:] = 0
    out = np.empty((1, int(few.slots[side, 1]), few.n_distinct, few.rows, few.width))
    DRAWN.clear()
    workspace.run(0, count, [KEY], out, threading.Event())


# In a crowd from the first ray on, where a coin chooses a branch.
rays.CROWD = 0

WALKS = {
    "analog": partial(_analog, STACK, 600),
    "split": partial(_replicate, "split", STACK, UP, 100),
    "split azimuths": partial(_replicate, "split", PLASTIC, UP, 300),
    "connection": partial(_replicate, "connection", PLASTIC, UP, 40),
    "operator out": partial(_replicate, "operator", STACK, UP, 100),
    "operator in": partial(_replicate, "operator", [NARROW, medium(0.5), BASE], UP, 100),
    "operator lit": partial(_replicate, "operator", SLAB, DOWN, 100),
    "many paths": partial(_replicate, "operator", [ROUGH, medium(2.0), BASE], UP, 600),
}


def main():
    """Write what each walk drew to standard output."""
    found = {}
    for name in sys.argv[1:] or WALKS:
        WALKS[name]()
        found[name] = list(DRAWN)
    json.dump(found, sys.stdout)


if __name__ == "__main__":
    main()
