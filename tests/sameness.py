"""Whether results are the same: all of their numbers, as bytes."""

from goniosim.engine.packing import pack

FIELDS = ("energy", "stderr", "bsdf", "bsdf_stderr", "albedo", "albedo_stderr")
OPTIONAL = ("uncertain", "hits", "batches", "node_bias", "paths", "replicates")


def content(result):
    """Everything but times and words."""
    parts = [result.rays, result.status, result.cost.rays, result.cost.error]
    parts += [result.audit.energy, result.audit.stderr, result.audit.rays]
    for name, component in result.components.items():
        for one in (component, *component.orders.values()):
            parts += [name, one.estimator, one.contains_delta]
            parts += [getattr(one, field) for field in (*FIELDS, *OPTIONAL)]
    return pack(parts)
