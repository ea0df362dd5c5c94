"""How datasets and texts are put into HDF5: the same for results and for integrated models."""

from typing import Any

import h5py
import numpy as np

from goniosim.store.layout import SCALES, Dataset

# Any HDF5 since 1.10 (2016) can read this format, and the bytes do not depend on the installed one.
FORMAT = ("v110", "v110")


def write_dataset(root: h5py.Group, path: str, values: Any, entry: Dataset) -> None:
    """Write a dataset with its units, scales and coordinates.

    Scales come first, so that the datasets that use them can be attached as they are made.

    Parameters
    ----------
    root : h5py.Group
        Laid out like the root of a result file.
    path : str
        Below ``root``.
    values : array-like
    entry : goniosim.store.layout.Dataset

    Raises
    ------
    ValueError
        If a number is not finite.
    """
    values = stored(path, values, entry.dtype)
    # HDF5 cannot chunk an empty dataset, and there is nothing in it to protect.
    filters = {}
    if values.size:
        # One slice per chunk. Level 1: level 4 saves 1 % of Monte Carlo noise, shuffling 10 %.
        chunks = (1,) * (values.ndim - 2) + values.shape[-2:]
        filters = {"chunks": chunks, "fletcher32": True, "shuffle": True, "compression": 1}
    dataset = root.create_dataset(path, data=values, track_times=False, **filters)

    write_text(dataset, "units", entry.unit)
    write_text(dataset, "long_name", entry.meaning)
    if entry.dtype == "bool":
        write_text(dataset, "dtype", "bool")
    if entry.dtype == "text":
        write_text(dataset, "_Encoding", "utf-8")
    if entry.is_scale:
        dataset.make_scale(entry.dims[0])
    else:
        for axis, dim in enumerate(entry.dims):
            dataset.dims[axis].attach_scale(root[SCALES[dim]])
        _link_coordinates(root, path, dataset, entry)


def _link_coordinates(root: h5py.Group, path: str, dataset: h5py.Dataset, entry: Dataset) -> None:
    """Hard links to the coordinates of a dataset beside it, where xarray looks for them."""
    coordinates = {dim: SCALES[dim] for dim in entry.dims}
    if "direction" in entry.dims and not path.startswith("incident/"):
        coordinates |= {name: f"incident/{name}" for name in ("theta_deg", "phi_deg")}
        write_text(dataset, "coordinates", "theta_deg phi_deg")
    for name, target in coordinates.items():
        if name not in dataset.parent:
            dataset.parent[name] = root[target]


def stored(path: str, values: Any, dtype: str) -> np.ndarray:
    """Values in the type that the file holds."""
    if dtype == "text":
        raw = [utf8(text) for text in values]
        return np.array(raw).astype(h5py.string_dtype("utf-8", max(1, *map(len, raw))))
    if dtype == "bool":
        return np.asarray(values).astype(bool, casting="safe").astype(np.int8)
    values = np.asarray(values).astype(dtype, casting="safe", copy=False)
    if not np.isfinite(values).all():
        raise ValueError(f"{path} holds NaN or infinity")
    return values


def utf8(text: str) -> bytes:
    """Bytes of a text, as a file holds them."""
    # A path or an argument from the shell may hold bytes that are not text: finished work is worth more.
    return text.encode("utf-8", "backslashreplace").rstrip(b"\0")


def write_text(node: h5py.Group | h5py.Dataset, name: str, text: str) -> None:
    """Set a text attribute of a group or dataset."""
    # Fixed length, because HDF5 keeps texts of variable length in a heap without a checksum.
    raw = utf8(text)
    node.attrs.create(name, raw, dtype=h5py.string_dtype("utf-8", max(1, len(raw))))
