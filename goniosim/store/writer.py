"""From a result in memory to the bytes of a file, and onto the disk."""

import uuid
from collections.abc import Iterator, Mapping
from typing import Any

import h5py
import numpy as np

from goniosim.errors import OutputError
from goniosim.result import Component, Result
from goniosim.store import userblock
from goniosim.store.layout import COMPONENTS, FILETYPE, NOT_PROVENANCE, SCALES, SCHEMA_VERSION, Dataset, describe
from goniosim.store.output import Reservation, rescue, reserve_output
from goniosim.store.userblock import StrPath

# Any HDF5 since 1.10 (2016) can read this format, and the bytes do not depend on the installed one.
_FORMAT = ("v110", "v110")


def write_result(result: Result, path: StrPath, *, reservation: Reservation | None = None) -> None:
    """Write a result file, whole or not at all.

    Parameters
    ----------
    result : Result
    path : path-like
        Replaced if it is an earlier result.
    reservation : Reservation, optional
        Of the same path, made by `reserve_output` before the computation.
        It is used up.

    Raises
    ------
    OutputError
        If the file cannot be written there; the result is then saved in the
        temporary directory, and the message says where.
    ValueError
        If the result contradicts the schema (a NaN, a wrong shape): a fault
        of the program.
    """
    parts = encode(result)
    try:
        if reservation is None:
            reservation = reserve_output(path, sum(map(len, parts)))
        with reservation:
            reservation.commit(parts)
    except OutputError as error:
        raise OutputError(f"{error}; {rescue(parts, path)}") from error


def encode(result: Result) -> tuple[bytes, bytes]:
    """Bytes of a result file.

    Equal results give equal bytes: no clock and no random number goes in.

    Parameters
    ----------
    result : Result

    Returns
    -------
    tuple of bytes
        The user block and the HDF5 image that follows it.

    Raises
    ------
    ValueError
        If the result contradicts the schema.
    """
    attributes = _root_attributes(result)
    sizes = {
        "direction": len(result.theta_deg),
        "channel": len(result.channels),
        "row": len(result.cells.row_edges) - 1,
        "column": len(result.cells.column_edges) - 1,
        "row_edges": len(result.cells.row_edges),
        "column_edges": len(result.cells.column_edges),
        "rays": len(result.cost.rays),
    }
    with h5py.File(
        uuid.uuid4().hex, "w", driver="core", backing_store=False, libver=_FORMAT, userblock_size=userblock.SIZE
    ) as file:
        # Scales come first in this order, so that datasets can be attached to them as they are made.
        for path, values in _arrays(result):
            _write_dataset(file, path, values, sizes)
        for path, component in _components(result.components):
            file[path].attrs["contains_delta"] = np.int8(component.contains_delta)
        _write_text(file["cells"], "parametrization", result.cells.parametrization)
        effects = file.create_group("effects")
        for name, called_for in result.effects.items():
            effects.attrs[name] = np.int8(called_for)
        for name, value in attributes.items():
            if isinstance(value, int):
                file.attrs[name] = np.uint64(value)
            else:
                _write_text(file, name, value)
        file.flush()
        image = file.id.get_file_image()
    return userblock.make(image, attributes), image


def _root_attributes(result: Result) -> dict[str, str | int]:
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
        **result.provenance,
    }
    # What is hashed must be what a reader gets back.
    return {"seed": int(result.seed), **{name: _utf8(text).decode() for name, text in texts.items()}}


def _utf8(text: str) -> bytes:
    # A path or an argument from the shell may hold bytes that are not text: finished work is worth more.
    return text.encode("utf-8", "backslashreplace").rstrip(b"\0")


def _components(components: Mapping[str, Component], parent: str = "") -> Iterator[tuple[str, Component]]:
    """Paths and components, orders after the component that they decompose."""
    for name, component in components.items():
        if not parent and name not in COMPONENTS:
            raise ValueError(f"the schema has no component {name}")
        yield parent + name, component
        yield from _components(component.orders, f"{parent}{name}/")


def _arrays(result: Result) -> Iterator[tuple[str, Any]]:
    """Path and values of every dataset of the file."""
    cells = result.cells
    yield "direction", np.arange(len(result.theta_deg))
    yield "channel", result.channels
    yield "row", (cells.row_edges[:-1] + cells.row_edges[1:]) / 2
    yield "column", (cells.column_edges[:-1] + cells.column_edges[1:]) / 2
    yield "incident/theta_deg", result.theta_deg
    yield "incident/phi_deg", result.phi_deg
    yield "incident/rays", result.rays
    yield "channels/name", result.channels
    for name in ("row_edges", "column_edges", "valid", "solid_angle", "projected_solid_angle"):
        yield f"cells/{name}", getattr(cells, name)
    for path, component in _components(result.components):
        for name in ("energy", "stderr", "bsdf", "bsdf_stderr"):
            yield f"{path}/{name}", getattr(component, name)
        if component.hits is not None:
            yield f"{path}/hits", component.hits
    for entry in result.audit.energy:
        yield f"audit/{entry}", result.audit.energy[entry]
        yield f"audit/{entry}_stderr", result.audit.stderr[entry]
    yield "audit/direct_integrated", result.audit.direct_integrated
    yield "audit/direct_integrated_stderr", result.audit.direct_integrated_stderr
    for name in ("rays", "seconds", "cpu_seconds"):
        yield f"cost/{name}", getattr(result.cost, name)
    for sampled, error in result.cost.error.items():
        yield f"cost/error_{sampled.replace('/', '_')}", error


def _write_dataset(file: h5py.File, path: str, values: Any, sizes: Mapping[str, int]) -> None:
    entry = describe(path)
    values = _stored(path, values, entry.dtype)
    if values.shape != tuple(sizes[dim] for dim in entry.dims):
        raise ValueError(f"{path} has shape {values.shape}, not {entry.dims} of {sizes}")

    # HDF5 cannot chunk an empty dataset, and there is nothing in it to protect.
    filters = {}
    if values.size:
        # One slice per chunk. Level 1: level 4 saves 1 % of Monte Carlo noise, shuffling 10 %.
        chunks = (1,) * (values.ndim - 2) + values.shape[-2:]
        filters = {"chunks": chunks, "fletcher32": True, "shuffle": True, "compression": 1}
    dataset = file.create_dataset(path, data=values, track_times=False, **filters)

    _write_text(dataset, "units", entry.unit)
    _write_text(dataset, "long_name", entry.meaning)
    if entry.dtype == "bool":
        _write_text(dataset, "dtype", "bool")
    if entry.dtype == "text":
        _write_text(dataset, "_Encoding", "utf-8")
    if entry.is_scale:
        dataset.make_scale(entry.dims[0])
    else:
        for axis, dim in enumerate(entry.dims):
            dataset.dims[axis].attach_scale(file[SCALES[dim]])
        _link_coordinates(file, dataset, entry)


def _link_coordinates(file: h5py.File, dataset: h5py.Dataset, entry: Dataset) -> None:
    """Hard links to the coordinates of a dataset beside it, where xarray looks for them."""
    coordinates = {dim: SCALES[dim] for dim in entry.dims}
    if "direction" in entry.dims and dataset.parent.name != "/incident":
        coordinates |= {name: f"incident/{name}" for name in ("theta_deg", "phi_deg")}
        _write_text(dataset, "coordinates", "theta_deg phi_deg")
    for name, target in coordinates.items():
        if name not in dataset.parent:
            dataset.parent[name] = file[target]


def _stored(path: str, values: Any, dtype: str) -> np.ndarray:
    """Values in the type that the file holds."""
    if dtype == "text":
        raw = [_utf8(text) for text in values]
        return np.array(raw).astype(h5py.string_dtype("utf-8", max(1, *map(len, raw))))
    if dtype == "bool":
        return np.asarray(values).astype(bool, casting="safe").astype(np.int8)
    values = np.asarray(values).astype(dtype, casting="safe", copy=False)
    if not np.isfinite(values).all():
        raise ValueError(f"{path} holds NaN or infinity")
    return values


def _write_text(node: h5py.Group | h5py.Dataset, name: str, text: str) -> None:
    # Fixed length, because HDF5 keeps texts of variable length in a heap without a checksum.
    raw = _utf8(text)
    node.attrs.create(name, raw, dtype=h5py.string_dtype("utf-8", max(1, len(raw))))
