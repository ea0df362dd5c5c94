"""From a result in memory to the bytes of a file."""

import uuid
from collections.abc import Iterator, Mapping
from typing import Any

import h5py
import numpy as np

from goniosim.result import Component, Result
from goniosim.store.encoding import FORMAT, reserve_seal, sealed, utf8, write_attributes, write_dataset, write_text
from goniosim.store.kinds import RESULT
from goniosim.store.layout import COMPONENTS, FILETYPE, NOT_PROVENANCE, SCHEMA_VERSION, describe
from goniosim.sums import BLOCKS, block_starts

# Arrays of a component that not every one has.
OPTIONAL = ("hits", "uncertain", "albedo", "albedo_stderr", "node_bias", "batches", "paths", "replicates")


def encode(result: Result) -> tuple[memoryview | bytes, ...]:
    """Bytes of a result file.

    Equal results give equal bytes: no clock and no random number goes in.

    Parameters
    ----------
    result : Result

    Returns
    -------
    tuple of bytes-like
        The file, one part after the other: what comes before the seal, the seal, and the rest.

    Raises
    ------
    ValueError
        If the result contradicts the schema.
    """
    attributes = root_attributes(result)
    batches = _batches_of(result)
    sizes = {
        "direction": len(result.theta_deg),
        "channel": len(result.channels),
        "row": len(result.cells.row_edges) - 1,
        "column": len(result.cells.column_edges) - 1,
        "row_edges": len(result.cells.row_edges),
        "column_edges": len(result.cells.column_edges),
        "checkpoint": result.cost.checkpoints,
    }
    if batches is not None:
        sizes |= dict(zip(("batch", "row_block", "column_block"), (batches.shape[n] for n in (1, 3, 4)), strict=True))
    with h5py.File(uuid.uuid4().hex, "w", driver="core", backing_store=False, libver=FORMAT) as file:
        place = reserve_seal(file)
        for path, values in arrays(result):
            entry = describe(path)
            shape = tuple(sizes[dim] for dim in entry.dims)
            if entry.dtype != "bytes" and np.shape(values) != shape:
                raise ValueError(f"{path} has shape {np.shape(values)}, not {shape}")
            write_dataset(file, path, values, entry)
        for path, component in components_of(result.components):
            file[path].attrs["contains_delta"] = np.int8(component.contains_delta)
        write_text(file["cells"], "parametrization", result.cells.parametrization)
        effects = file.create_group("effects")
        for name, called_for in result.effects.items():
            effects.attrs[name] = np.int8(called_for)
        write_attributes(file, attributes)
        return sealed(file, RESULT, place)


def _batches_of(result: Result) -> np.ndarray | None:
    """Batches of some component, all of which have the same shape; None if no component has any."""
    found = (part.batches for _, part in components_of(result.components) if part.batches is not None)
    return next(found, None)


def root_attributes(result: Result) -> dict[str, str | int]:
    """Attributes of the root of a result file; a ValueError if the result contradicts the schema."""
    if result.status not in ("complete", "partial"):
        raise ValueError(f"status is {result.status!r}, not 'complete' or 'partial'")
    missing = {"created_utc", "goniosim_version"} - result.provenance.keys()
    clash = result.provenance.keys() & set(NOT_PROVENANCE)
    if missing or clash:
        raise ValueError(f"provenance lacks {sorted(missing)}, or uses the reserved names {sorted(clash)}")
    texts = {
        "filetype": FILETYPE,
        "schema_version": SCHEMA_VERSION,
        "config_yaml": result.config_yaml,
        "config_hash": result.config_hash,
        "status": result.status,
        "name": result.name,
        "estimator": result.estimator,
        **result.provenance,
    }
    reached = {} if result.target_reached is None else {"target_reached": int(result.target_reached)}
    # What is hashed must be what a reader gets back.
    return {"seed": int(result.seed), **reached, **{name: utf8(text).decode() for name, text in texts.items()}}


def components_of(components: Mapping[str, Component], parent: str = "") -> Iterator[tuple[str, Component]]:
    """Paths and components, orders after the component that they decompose."""
    for name, component in components.items():
        if not parent and name not in COMPONENTS:
            raise ValueError(f"the schema has no component {name}")
        yield parent + name, component
        yield from components_of(component.orders, f"{parent}{name}/")


def arrays(result: Result) -> Iterator[tuple[str, Any]]:
    """Path and values of every dataset of a result file, scales first."""
    cells = result.cells
    yield "direction", np.arange(len(result.theta_deg))
    yield "channel", result.channels
    yield "row", (cells.row_edges[:-1] + cells.row_edges[1:]) / 2
    yield "column", (cells.column_edges[:-1] + cells.column_edges[1:]) / 2
    batches = _batches_of(result)
    if batches is not None:
        rows, columns = (len(edges) - 1 for edges in (cells.row_edges, cells.column_edges))
        yield "batch", np.arange(batches.shape[1])
        yield "row_block", block_starts(rows, BLOCKS[0])
        yield "column_block", block_starts(columns, BLOCKS[1])
    yield "incident/theta_deg", result.theta_deg
    yield "incident/phi_deg", result.phi_deg
    yield "incident/rays", result.rays
    yield "channels/name", result.channels
    for name in ("row_edges", "column_edges", "valid", "solid_angle", "projected_solid_angle"):
        yield f"cells/{name}", getattr(cells, name)
    for path, component in components_of(result.components):
        for name in ("energy", "stderr", "bsdf", "bsdf_stderr"):
            yield f"{path}/{name}", getattr(component, name)
        for name in OPTIONAL:
            if getattr(component, name) is not None:
                yield f"{path}/{name}", getattr(component, name)
        yield f"{path}/estimator", component.estimator
    for entry in result.audit.energy:
        yield f"audit/{entry}", result.audit.energy[entry]
        yield f"audit/{entry}_stderr", result.audit.stderr[entry]
    yield "audit/direct_integrated", result.audit.direct_integrated
    yield "audit/direct_integrated_stderr", result.audit.direct_integrated_stderr
    if result.audit.rays is not None:
        yield "audit/rays", result.audit.rays
    yield "cost/checkpoint", np.arange(result.cost.checkpoints)
    for name in ("rays", "seconds", "cpu_seconds"):
        yield f"cost/{name}", getattr(result.cost, name)
    for sampled, error in result.cost.error.items():
        yield f"cost/error_{sampled.replace('/', '_')}", error
    if result.state is not None:
        yield "state", bytes(result.state)
