"""How datasets and texts are put into HDF5: the same for results and for integrated models."""

import hashlib
import io
from collections.abc import Mapping
from typing import Any

import h5py
import numpy as np

from goniosim.store import chunks, manifest, seal
from goniosim.store.access import chunk_shape
from goniosim.store.kinds import Kind
from goniosim.store.layout import CHECKSUMS, SCALES, Dataset, angles_of

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
    # HDF5 cannot chunk an empty dataset, and there is nothing in it to protect; nor a single number or row of bytes.
    is_chunked = values.size > 0 and values.ndim > 0
    filters = {"chunks": chunk_shape(values.shape), **chunks.FILTERS} if is_chunked else {}
    dataset = root.create_dataset(path, values.shape, values.dtype, track_times=False, **filters)
    if is_chunked:
        chunks.write(dataset, values)
    elif values.size:
        dataset[()] = values
    _write_meaning(dataset, entry)
    write_text(dataset, manifest.VALUES, manifest.digest_of_values(values))
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


def reserve_seal(file: h5py.File) -> int:
    """Make room for the seal, before anything else is written; return its place in the file."""
    dataset = _write_scalar(file, CHECKSUMS[0], bytes(seal.SIZE), seal.SIZE)
    # The file grows only now.
    file.flush()
    place = dataset.id.get_offset()
    assert place + seal.SIZE <= seal.WINDOW
    return place


def write_attributes(file: h5py.File, attributes: Mapping[str, str | int]) -> None:
    """Set texts and whole numbers as attributes of the root."""
    for name, value in attributes.items():
        if isinstance(value, int):
            file.attrs[name] = np.uint64(value)
        else:
            write_text(file, name, value)


def sealed(file: h5py.File, kind: Kind, place: int) -> tuple[memoryview | bytes, ...]:
    """Bytes of a file in memory, after everything else is written: what comes before the seal, the seal, the rest.

    Parameters
    ----------
    file : h5py.File
    kind : goniosim.store.kinds.Kind
    place : int
        Of the seal, see `reserve_seal`.
    """
    content_digest = write_manifest(file)
    file.flush()
    image = file.id.get_file_image()
    digest = seal.digest(io.BytesIO(image), place)
    view = memoryview(image)
    return view[:place], seal.make(kind, len(image), digest, content_digest), view[place + seal.SIZE :]


def write_manifest(file: h5py.File) -> str:
    """Write the manifest, after everything else; return its digest for the seal."""
    text = manifest.build(file)
    _write_scalar(file, CHECKSUMS[1], text, len(text))
    return hashlib.sha256(text).hexdigest()


def _write_scalar(file: h5py.File, entry: Dataset, text: bytes, size: int) -> h5py.Dataset:
    kind = h5py.string_dtype("utf-8", size)
    dataset = file.create_dataset(entry.path, data=np.array(text, kind), dtype=kind, track_times=False)
    _write_meaning(dataset, entry)
    return dataset


def _write_meaning(dataset: h5py.Dataset, entry: Dataset) -> None:
    write_text(dataset, "units", entry.unit)
    write_text(dataset, "long_name", entry.meaning)


def _link_coordinates(root: h5py.Group, path: str, dataset: h5py.Dataset, entry: Dataset) -> None:
    """Hard links to the coordinates of a dataset beside it, where xarray looks for them."""
    angles = angles_of(path, entry)
    if angles:
        write_text(dataset, "coordinates", " ".join(angles))
    for name, target in ({dim: SCALES[dim] for dim in entry.dims} | angles).items():
        if name not in dataset.parent:
            dataset.parent[name] = root[target]


def stored(path: str, values: Any, dtype: str) -> np.ndarray:
    """Values in the type that the file holds."""
    if dtype == "text":
        raw = [utf8(text) for text in values]
        return np.array(raw).astype(h5py.string_dtype("utf-8", max(1, *map(len, raw))))
    if dtype == "bytes":
        return np.array(values, np.dtype(("S", len(values))))
    if dtype == "bool":
        return np.asarray(values).astype(bool, casting="safe").astype(np.int8)
    values = np.asarray(values).astype(np.dtype(dtype).newbyteorder("<"), casting="safe", copy=False)
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
