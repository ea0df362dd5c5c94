"""From a result file back to a result in memory; every way in which a file can be wrong has its own error."""

import contextlib
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, BinaryIO

import h5py
import numpy as np

from goniosim.errors import DamagedFileError
from goniosim.result import AUDIT_ENTRIES, Audit, Cells, Component, Cost, Result
from goniosim.store import userblock
from goniosim.store.layout import COMPONENTS, NOT_PROVENANCE, SCALES, describe
from goniosim.store.userblock import StrPath

_ORDER = re.compile(r"order_(\d+)(?:_and_more)?")


def open_result(path: StrPath) -> Result:
    """Read a result file and check every byte of it.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    Result

    Raises
    ------
    ForeignFileError
        If the file is missing or is not a goniosim result.
    DamagedFileError
        If it was truncated or altered since it was written.
    NewerSchemaError
        If its major schema version is newer than this goniosim reads.
    """
    with userblock.open_regular(path) as stream:
        block = userblock.read(stream, path)
        userblock.verify(stream, block, path)
        with _hdf5(stream, path) as file:
            return _result(file)


def read_header(path: StrPath) -> dict[str, str | int]:
    """Read the root attributes of a result file, without its data.

    The attributes are checked against their digest and the file against its
    length; damage elsewhere is left for `open_result` to find.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    dict of str to str or int
        ``name``, ``status``, ``seed``, ``config_yaml``, ``schema_version``, ...

    Raises
    ------
    ForeignFileError, DamagedFileError, NewerSchemaError
        As `open_result`.
    """
    with userblock.open_regular(path) as stream:
        block = userblock.read(stream, path)
        with _hdf5(stream, path) as file:
            attributes = _attributes(file)
        if userblock.attributes_digest(attributes) != block.attributes_digest:
            raise DamagedFileError(f"{path}: its root attributes are damaged; {userblock.REMEDY}")
        return attributes


@contextlib.contextmanager
def _hdf5(stream: BinaryIO, path: StrPath) -> Iterator[h5py.File]:
    """The HDF5 part of an open file; whatever HDF5 or h5py trips over is damage.

    Reading through the stream that was verified leaves no moment in which
    another file could take its place, and needs no file locks, which some
    network file systems lack.
    """
    try:
        with h5py.File(stream, "r") as file:
            yield file
    except (OSError, RuntimeError, LookupError, TypeError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise DamagedFileError(f"{path}: cannot be decoded: {reason}; {userblock.REMEDY}") from error


def _attributes(file: h5py.File) -> dict[str, Any]:
    return {name: _plain(value) for name, value in file.attrs.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, bytes):
        return value.decode()
    return value.tolist() if isinstance(value, np.generic | np.ndarray) else value


def _result(file: h5py.File) -> Result:
    sizes = {dim: len(_dataset(file, scale)) for dim, scale in SCALES.items()}

    def read(path: str) -> Any:
        return _read(file, path, sizes)

    attributes = _attributes(file)
    return Result(
        config_yaml=attributes["config_yaml"],
        config_hash=attributes["config_hash"],
        name=attributes["name"],
        status=attributes["status"],
        seed=attributes["seed"],
        theta_deg=read("incident/theta_deg"),
        phi_deg=read("incident/phi_deg"),
        rays=read("incident/rays"),
        channels=read("channels/name"),
        cells=Cells(
            parametrization=_plain(file["cells"].attrs["parametrization"]),
            row_edges=read("cells/row_edges"),
            column_edges=read("cells/column_edges"),
            valid=read("cells/valid"),
            solid_angle=read("cells/solid_angle"),
            projected_solid_angle=read("cells/projected_solid_angle"),
        ),
        components={path: _component(file, path, read) for path in COMPONENTS if path in file},
        audit=Audit(
            energy={entry: read(f"audit/{entry}") for entry in AUDIT_ENTRIES},
            stderr={entry: read(f"audit/{entry}_stderr") for entry in AUDIT_ENTRIES},
            direct_integrated=read("audit/direct_integrated"),
            direct_integrated_stderr=read("audit/direct_integrated_stderr"),
        ),
        cost=_cost(file, read),
        effects={name: bool(called_for) for name, called_for in file["effects"].attrs.items()},
        provenance={
            name: value for name, value in attributes.items() if name not in NOT_PROVENANCE and isinstance(value, str)
        },
    )


def _component(file: h5py.File, path: str, read: Callable[[str], Any]) -> Component:
    orders = sorted((int(match[1]), match[0]) for match in map(_ORDER.fullmatch, file[path]) if match)
    return Component(
        energy=read(f"{path}/energy"),
        stderr=read(f"{path}/stderr"),
        bsdf=read(f"{path}/bsdf"),
        bsdf_stderr=read(f"{path}/bsdf_stderr"),
        hits=read(f"{path}/hits") if "hits" in file[path] else None,
        contains_delta=bool(file[path].attrs["contains_delta"]),
        orders={name: _component(file, f"{path}/{name}", read) for _, name in orders},
    )


def _cost(file: h5py.File, read: Callable[[str], Any]) -> Cost:
    errors = {component: f"cost/error_{component.replace('/', '_')}" for component in COMPONENTS}
    return Cost(
        rays=read("cost/rays"),
        seconds=read("cost/seconds"),
        cpu_seconds=read("cost/cpu_seconds"),
        error={component: read(path) for component, path in errors.items() if path in file},
    )


def _read(file: h5py.File, path: str, sizes: Mapping[str, int]) -> Any:
    entry = describe(path)
    values = _dataset(file, path)[()]
    if values.shape != tuple(sizes[dim] for dim in entry.dims):
        raise ValueError(f"the dataset {path} has shape {values.shape}, not {entry.dims} of {sizes}")
    if entry.dtype == "text":
        return [_plain(text) for text in values]
    return values.astype(entry.dtype, copy=False)


def _dataset(file: h5py.File, path: str) -> h5py.Dataset:
    if path not in file:
        raise ValueError(f"the dataset {path} is missing")
    return file[path]
