"""How datasets and attributes become what the rest of goniosim knows: of the type, shape and range of the schema."""

from collections.abc import Callable, Mapping
from typing import Any

import h5py
import numpy as np

from goniosim.result import Cells
from goniosim.store import access
from goniosim.store.layout import Dataset

# Bytes of a name.
_LONGEST_NAME = 1000


def shaped(root: h5py.Group, path: str, entry: Dataset, sizes: Mapping[str, int]) -> h5py.Dataset:
    """A dataset of the type and shape that the schema gives it; a ValueError if it has others.

    Parameters
    ----------
    root : h5py.Group
    path : str
    entry : goniosim.store.layout.Dataset
    sizes : dict of str to int
        Length of each dimension.
    """
    found = access.dataset(root, path)
    shape = tuple(sizes[dim] for dim in entry.dims)
    if found.shape != shape:
        raise ValueError(f"{path} has shape {found.shape}, not {shape}")
    fixed = f"S{found.dtype.itemsize}"
    expected = {"text": fixed, "bytes": fixed, "bool": "int8"}.get(entry.dtype, entry.dtype)
    if found.dtype != np.dtype(expected).newbyteorder("<") or (entry.dtype == "text" and not _is_short(found)):
        raise ValueError(f"{path} has the type {found.dtype}, not {entry.dtype}")
    return found


def _is_short(found: h5py.Dataset) -> bool:
    return found.dtype.kind == "S" and found.dtype.itemsize <= _LONGEST_NAME


def values(found: h5py.Dataset, entry: Dataset) -> Any:
    """Values of a dataset in the type of the schema: a list of str, or an ndarray.

    Raises
    ------
    ValueError
        If a number is out of range.
    """
    raw = access.read(found)
    if entry.dtype == "text":
        return [word.decode() for word in raw.tolist()]
    if entry.dtype == "bytes":
        return raw.tobytes()
    if not entry.range.holds(raw):
        raise ValueError(f"{found.name} must be {entry.range}")
    return raw.astype(entry.dtype, copy=False)


def cells(root: h5py.Group, read: Callable[[str], Any]) -> Cells:
    """The cells of a result or of a material.

    Parameters
    ----------
    root : h5py.Group
    read : callable
        ``read(path)``: values of a dataset.

    Returns
    -------
    goniosim.result.Cells
    """
    names = ("row_edges", "column_edges", "valid", "solid_angle", "projected_solid_angle")
    parametrization = access.text(access.group(root, "cells"), "parametrization")
    return Cells(parametrization, **{name: read(f"cells/{name}") for name in names})
