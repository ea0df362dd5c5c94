"""Estimators of what leaves a stack: one file each.

An estimator makes *replicates*: independent, unbiased estimates of the slices, each from a key of its own. Whatever
it does within one (lattices, shared paths, many deposits of one path), the scatter of the replicates is an honest
error. `analog`, whose paths are independent and tell their own error, stands beside them in `goniosim.engine.analog`.

Every estimator is a class of ways out with

``name``
    As in ``simulation.estimator``.
``chunk``
    Replicates that one call of ``run`` makes at the most.
``smallest``
    Light paths of a replicate, at least.
``mends``
    Whether the variance of cells with few hits is mended, see `goniosim.engine.mending`.
``has_nodes``
    Whether it interpolates between nodes; ``run`` then takes ``stride=2`` to use every second one.
``refusal(plan, sides)``
    One sentence why it does not apply to these ways out, or None.
``tiny(plan, sides)``
    One that runs the same kernels for as little as they can do: they are compiled with it.
``prepare()``
    Makes what all incident directions share, before anything is run.
``memory``
    Bytes, from shapes alone: shared by all threads, and of one workspace.
``workspace()``
    Scratch arrays of one thread, with ``run(direction, size, keys, out, stop)``: replicates of ``size`` light paths
    for each of the keys, as energies [replicate, slot, channel, row, folded column]; returns events.

A new one is a new file and a line here; the order is that in which ``auto`` tries them.
"""

from .connection import Connection
from .operator import Operator
from .split import Split

ESTIMATORS = {each.name: each for each in (Connection, Operator, Split)}
