"""From a result file back to a result in memory; every way in which a file can be wrong has its own error."""

import contextlib
import re
from collections.abc import Callable, Iterator
from typing import Any, BinaryIO

import h5py

from goniosim.errors import DamagedFileError, ForeignFileError, UnusableResultError
from goniosim.result import AUDIT_ENTRIES, Audit, Component, Cost, Result
from goniosim.store import userblock
from goniosim.store.decoding import attributes, cells, decoding, find, find_shaped, values
from goniosim.store.layout import COMPONENTS, NOT_PROVENANCE, SCALES, describe
from goniosim.store.models.reader import is_models_file
from goniosim.writing import StrPath

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
    UnusableResultError
        If it is a file of integrated models: `goniosim.store.open_models` reads those.

    Examples
    --------
    >>> goniosim.open_result("result.h5").status
    'complete'
    """
    with userblock.open_regular(path) as stream:
        block = _user_block(stream, path)
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
    ForeignFileError, DamagedFileError, NewerSchemaError, UnusableResultError
        As `open_result`.
    """
    with userblock.open_regular(path) as stream:
        block = _user_block(stream, path)
        with _hdf5(stream, path) as file:
            found = attributes(file)
        if userblock.attributes_digest(found) != block.attributes_digest:
            raise DamagedFileError(f"{path}: its root attributes are damaged; {userblock.REMEDY}")
        return found


def _user_block(stream: BinaryIO, path: StrPath) -> userblock.UserBlock:
    try:
        return userblock.read(stream, path)
    except ForeignFileError:
        if is_models_file(path):
            raise UnusableResultError(
                f"{path}: holds integrated models and no simulation; name a file that `goniosim simulate` wrote "
                "(`goniosim info`, `goniosim plot` and goniosim.store.open_models take this one)"
            ) from None
        raise


@contextlib.contextmanager
def _hdf5(stream: BinaryIO, path: StrPath) -> Iterator[h5py.File]:
    """The HDF5 part of an open file; whatever HDF5 or h5py trips over is damage.

    Reading through the stream that was verified leaves no moment in which
    another file could take its place, and needs no file locks, which some
    network file systems lack.
    """
    with decoding(path, userblock.REMEDY), h5py.File(stream, "r") as file:
        yield file


def _result(file: h5py.File) -> Result:
    sizes = {dim: len(find(file, scale)) for dim, scale in SCALES.items()}

    def read(path: str) -> Any:
        entry = describe(path)
        return values(find_shaped(file, path, entry, sizes), entry)

    header = attributes(file)
    return Result(
        config_yaml=header["config_yaml"],
        config_hash=header["config_hash"],
        name=header["name"],
        status=header["status"],
        seed=header["seed"],
        theta_deg=read("incident/theta_deg"),
        phi_deg=read("incident/phi_deg"),
        rays=read("incident/rays"),
        channels=read("channels/name"),
        cells=cells(file, read),
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
            name: value for name, value in header.items() if name not in NOT_PROVENANCE and isinstance(value, str)
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
