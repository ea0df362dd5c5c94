"""What two results, or two files of them, have to agree in to the last bit: everything but times and machines."""

import h5py
import numpy as np

from goniosim.engine.packing import pack

TIMES = {"cost/seconds", "cost/cpu_seconds"}


def content(result):
    """Everything but times and words, as bytes."""
    parts = [result.rays, result.status, result.config_yaml, result.cost.rays, result.cost.error]
    parts += [result.audit.energy, result.audit.stderr]
    for name, component in result.components.items():
        for one in (component, *component.orders.values()):
            parts += [name, one.estimator, one.contains_delta]
            arrays = (
                getattr(one, field) for field in ("energy", "stderr", "bsdf", "bsdf_stderr", "albedo", "albedo_stderr")
            )
            parts += [*arrays, *(getattr(one, field) for field in ("uncertain", "hits", "batches", "node_bias"))]
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
