"""Whether results, or files of them, are the same: all of their numbers, as bytes."""

import h5py
import numpy as np

from goniosim.engine.packing import pack

FIELDS = ("energy", "stderr", "bsdf", "bsdf_stderr", "albedo", "albedo_stderr")
OPTIONAL = ("uncertain", "hits", "batches", "node_bias", "paths", "replicates")

TIMES = ("cost/seconds", "cost/cpu_seconds")


def content(result):
    """Everything but times and words."""
    parts = [result.rays, result.status, result.cost.rays, result.cost.error]
    parts += [result.audit.energy, result.audit.stderr, result.audit.rays]
    for name, component in result.components.items():
        for one in (component, *component.orders.values()):
            parts += [name, one.estimator, one.contains_delta]
            parts += [getattr(one, field) for field in (*FIELDS, *OPTIONAL)]
    return pack(parts)


def datasets(path):
    """Bytes of all datasets of a file but times and checksums, by their paths."""
    found = {}

    def take(name, node):
        if isinstance(node, h5py.Dataset) and name not in TIMES and not name.startswith("checksums"):
            found[name] = np.asarray(node[()]).tobytes()

    with h5py.File(path) as file:
        file.visititems(take)
    return found
