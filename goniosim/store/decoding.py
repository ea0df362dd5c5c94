"""How datasets and texts are got out of HDF5: whatever is not as described is damage."""

import contextlib
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import h5py
import numpy as np

from goniosim.errors import DamagedFileError
from goniosim.result import Cells
from goniosim.store.layout import Dataset
from goniosim.writing import StrPath


@contextlib.contextmanager
def decoding(path: StrPath, remedy: str) -> Iterator[None]:
    """Call whatever HDF5, h5py or the functions below trip over damage of the file ``path``.

    Parameters
    ----------
    path : path-like
    remedy : str
        What the user can do about it.

    Raises
    ------
    DamagedFileError
    """
    try:
        yield
    except (OSError, RuntimeError, LookupError, TypeError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise DamagedFileError(f"{path}: cannot be decoded: {reason}; {remedy}") from error


def attributes(node: h5py.Group) -> dict[str, Any]:
    """Attributes of a group, as texts and numbers of Python."""
    return {name: plain(value) for name, value in node.attrs.items()}


def text(node: h5py.Group, name: str) -> str:
    """A text attribute of a group; a ValueError if there is none."""
    value = plain(node.attrs.get(name))
    if not isinstance(value, str):
        raise ValueError(f"the attribute {name} of {node.name} is missing or not a text")
    return value


def plain(value: Any) -> Any:
    """A value of HDF5 as Python knows it."""
    if isinstance(value, bytes):
        return value.decode()
    return value.tolist() if isinstance(value, np.generic | np.ndarray) else value


def find(root: h5py.Group, path: str) -> h5py.Dataset:
    """A dataset below a group; a ValueError if there is none."""
    if not isinstance(root.get(path), h5py.Dataset):
        raise ValueError(f"the dataset {path} is missing")
    return root[path]


def find_shaped(root: h5py.Group, path: str, entry: Dataset, sizes: Mapping[str, int]) -> h5py.Dataset:
    """A dataset of the shape that the schema gives it; a ValueError if it has another.

    Parameters
    ----------
    root : h5py.Group
    path : str
    entry : goniosim.store.layout.Dataset
    sizes : dict of str to int
        Length of each dimension.
    """
    dataset = find(root, path)
    if dataset.shape != tuple(sizes[dim] for dim in entry.dims):
        raise ValueError(f"the dataset {path} has shape {dataset.shape}, not {entry.dims} of {sizes}")
    return dataset


def values(dataset: h5py.Dataset, entry: Dataset) -> Any:
    """Values of a dataset in the type of the schema: a list of str, or an ndarray."""
    found = dataset[()]
    if entry.dtype == "text":
        return [plain(word) for word in found]
    return found.astype(entry.dtype, copy=False)


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
    return Cells(text(root["cells"], "parametrization"), **{name: read(f"cells/{name}") for name in names})
