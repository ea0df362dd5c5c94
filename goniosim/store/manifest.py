"""What belongs to a file: a digest of every group and dataset that goniosim wrote, with its attributes.

It is the dataset `checksums/content`. When the bytes of a file are no longer those that were written, it tells
whether somebody only added something, such as a note, or changed what is ours. The values of a dataset have
their digest in its attribute ``sha256``.
"""

import hashlib
import json
from collections.abc import Iterator

import h5py
import numpy as np

from goniosim.store import access

PATH = "checksums/content"
VALUES = "sha256"
# What HDF5 itself keeps about dimension scales.
_BOOKKEEPING = {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"}

# Of each path: its digest and the names of its attributes; or the path that leads to the same object.
Entry = tuple[str, tuple[str, ...]] | str


def digest_of_values(values: np.ndarray) -> str:
    """SHA-256 of the stored values of a dataset in C order, hexadecimal."""
    return hashlib.sha256(np.ascontiguousarray(values).view(np.uint8).data).hexdigest()


def build(file: h5py.File) -> bytes:
    """The manifest of a file that is written but for its checksums, as JSON.

    Parameters
    ----------
    file : h5py.File

    Returns
    -------
    bytes
    """
    entries: dict[str, Entry] = {}
    places: dict[int, str] = {}
    for path, node in _walk(file, ""):
        address = _address(node)
        if address in places:
            entries[path] = places[address]
        else:
            places[address] = path
            names = tuple(sorted(set(node.attrs) - _BOOKKEEPING))
            entries[path] = _digest(node, names), names
    return json.dumps(entries, separators=(",", ":")).encode()


def _walk(group: h5py.Group, path: str) -> Iterator[tuple[str, h5py.Group | h5py.Dataset]]:
    yield path, group
    for name in group:
        below = f"{path}/{name}".lstrip("/")
        if below == PATH.split("/")[0]:
            continue
        if isinstance(group[name], h5py.Group):
            yield from _walk(group[name], below)
        else:
            yield below, group[name]


def _address(node: h5py.Group | h5py.Dataset) -> int:
    return int(h5py.h5o.get_info(node.id).addr)


def _digest(node: h5py.Group | h5py.Dataset, names: tuple[str, ...]) -> str:
    content: list[object] = [[name, access.attribute(node, name)] for name in names]
    if isinstance(node, h5py.Dataset):
        content += [node.dtype.str, list(node.shape)]
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()


class Manifest:
    """The manifest of a file that is open.

    Parameters
    ----------
    file : h5py.File
    digest : str
        Of the manifest itself, from the seal.

    Attributes
    ----------
    file : h5py.File

    Raises
    ------
    ValueError
        If it is missing or was altered.
    """

    def __init__(self, file: h5py.File, digest: str) -> None:
        found = access.dataset(file, PATH)
        if found.shape != () or found.dtype.kind != "S":
            raise ValueError(f"{PATH} is not a single text")
        raw = bytes(access.read(found)[()])
        if hashlib.sha256(raw).hexdigest() != digest:
            raise ValueError(f"{PATH} was changed")
        self.file = file
        self._entries: dict[str, Entry] = {}
        entries = json.loads(raw)
        if not isinstance(entries, dict):
            raise ValueError(f"{PATH} is not an object of JSON")
        for path, entry in entries.items():
            self._entries[path] = entry if isinstance(entry, str) else (str(entry[0]), tuple(map(str, entry[1])))

    def has(self, path: str) -> bool:
        """Whether a group or dataset is ours."""
        return path in self._entries

    def attributes(self, path: str) -> tuple[str, ...]:
        """Names of the attributes of a group that are ours."""
        entry = self._entries.get(path)
        return () if entry is None or isinstance(entry, str) else entry[1]

    def members(self, path: str) -> list[str]:
        """Names of what is ours in a group."""
        pieces = (each.rpartition("/") for each in self._entries if each)
        return [name for group, _, name in pieces if group == path]

    def hold_root(self) -> None:
        """Hold the attributes of the root against their digest; a ValueError if they were changed."""
        self._hold("", self.file)

    def hold_all(self) -> None:
        """Hold all that was written against its digests, values included.

        Raises
        ------
        ValueError
            If anything is missing or was changed; more may have been added.
        """
        nodes: dict[str, h5py.Group | h5py.Dataset] = {}
        for path, entry in self._entries.items():
            folder, _, name = path.rpartition("/")
            parent = nodes.get(folder, self.file) if path else self.file
            if not isinstance(parent, h5py.Group):
                raise ValueError(f"{folder} is not a group")
            node = access.node(parent, name)
            if isinstance(entry, str):
                if entry not in nodes or _address(node) != _address(nodes[entry]):
                    raise ValueError(f"{path} was replaced: it should be the same as {entry}")
            else:
                self._hold(path, node)
                changed = isinstance(node, h5py.Dataset) and (
                    digest_of_values(access.read(node)) != access.text(node, VALUES)
                )
                if changed:
                    raise ValueError(f"the values of {path} were changed")
            nodes[path] = node

    def _hold(self, path: str, node: h5py.Group | h5py.Dataset) -> None:
        entry = self._entries[path]
        if isinstance(entry, str) or _digest(node, entry[1]) != entry[0]:
            raise ValueError(f"{path or 'an attribute of the root'} was changed")


class NoManifest:
    """In place of the manifest of an earlier schema, which had none: all that is in the file belongs to it.

    Parameters
    ----------
    file : h5py.File
    """

    def __init__(self, file: h5py.File) -> None:
        self.file = file

    def has(self, path: str) -> bool:
        """Whether there is a group or dataset."""
        folder, _, name = path.rpartition("/")
        return (not folder or self.has(folder)) and access.has(access.group(self.file, folder), name)

    def attributes(self, path: str) -> tuple[str, ...]:
        """Names of those attributes of a group that are of a kind that goniosim writes."""
        group = access.group(self.file, path)
        return tuple(name for name in group.attrs if access.is_plain(group, name))

    def members(self, path: str) -> list[str]:
        """Names of what is in a group."""
        return list(access.group(self.file, path))
