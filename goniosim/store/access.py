"""Getting at what a file holds without trusting it: links, attributes and values are checked before they are used.

A file may come from a stranger. Nothing outside the file is followed, nothing is allocated that the file itself
does not pay for, and HDF5 is not asked to decompress. Whatever is not as goniosim writes it raises a ValueError.
"""

import math
import zlib

import h5py
import numpy as np

# Longest text; scene files have the same limit.
MAX_TEXT = 16_000_000
# Zeros deflate to a thousandth, and nothing to less.
_MOST_COMPRESSED = 1100
_NO_STORAGE = 4096
_DEFLATE, _SHUFFLE, _FLETCHER32 = h5py.h5z.FILTER_DEFLATE, h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_FLETCHER32
_FILTERS = (_SHUFFLE, _DEFLATE, _FLETCHER32)
_CHECKSUM_BYTES = 4


def has(group: h5py.Group, name: str) -> bool:
    """Whether a group has a link of that name, wherever it leads."""
    return bool(group.id.links.exists(name.encode()))


def node(root: h5py.Group, path: str) -> h5py.Group | h5py.Dataset:
    """What stands at a path, by hard links alone: no other file is opened, and no link leads round in circles.

    Parameters
    ----------
    root : h5py.Group
    path : str
        Names with ``/`` between; empty for the root itself.
    """
    found = root
    for name in path.split("/") if path else ():
        if not isinstance(found, h5py.Group) or not has(found, name):
            raise ValueError(f"{_below(found, name)} is missing")
        if found.id.links.get_info(name.encode()).type != h5py.h5l.TYPE_HARD:
            raise ValueError(f"{_below(found, name)} is a link that leads elsewhere")
        below = found[name]
        if not isinstance(below, h5py.Group | h5py.Dataset):
            raise ValueError(f"{_below(found, name)} is neither a group nor a dataset")
        found = below
    return found


def _below(owner: h5py.Group | h5py.Dataset, name: str) -> str:
    return f"{owner.name}/{name}".lstrip("/")


def group(root: h5py.Group, path: str) -> h5py.Group:
    """The group at a path."""
    found = node(root, path)
    if not isinstance(found, h5py.Group):
        raise ValueError(f"{path} is not a group")
    return found


def dataset(root: h5py.Group, path: str) -> h5py.Dataset:
    """The dataset at a path."""
    found = node(root, path)
    if not isinstance(found, h5py.Dataset):
        raise ValueError(f"{path} is not a dataset")
    return found


def has_attribute(owner: h5py.Group | h5py.Dataset, name: str) -> bool:
    """Whether a group or dataset has an attribute of that name."""
    return bool(h5py.h5a.exists(owner.id, name.encode()))


def is_plain(owner: h5py.Group | h5py.Dataset, name: str) -> bool:
    """Whether an attribute is a single text of fixed length, or a single whole number."""
    return _is_plain(h5py.h5a.open(owner.id, name.encode()))


def _is_plain(found: h5py.h5a.AttrID) -> bool:
    kind = found.get_type()
    is_text = isinstance(kind, h5py.h5t.TypeStringID) and not kind.is_variable_str()
    return found.shape == () and (is_text or isinstance(kind, h5py.h5t.TypeIntegerID)) and kind.get_size() <= MAX_TEXT


def attribute(owner: h5py.Group | h5py.Dataset, name: str) -> str | int:
    """An attribute: a single text of fixed length, or a single whole number."""
    if not has_attribute(owner, name):
        raise ValueError(f"the attribute {name} of {owner.name} is missing")
    found = h5py.h5a.open(owner.id, name.encode())
    if not _is_plain(found):
        raise ValueError(
            f"the attribute {name} of {owner.name} is neither a text of fixed length, below 16 MB, nor a whole number"
        )
    value = np.empty((), found.dtype)
    found.read(value)
    return value.item().decode() if value.dtype.kind == "S" else int(value)


def text(owner: h5py.Group | h5py.Dataset, name: str) -> str:
    """A text attribute."""
    value = attribute(owner, name)
    if not isinstance(value, str):
        raise ValueError(f"the attribute {name} of {owner.name} is not a text")
    return value


def flag(owner: h5py.Group, name: str) -> bool:
    """An attribute that is 1 or 0."""
    value = attribute(owner, name)
    if value not in (0, 1):
        raise ValueError(f"the attribute {name} of {owner.name} is {value!r}, not 0 or 1")
    return value == 1


def read(found: h5py.Dataset) -> np.ndarray:
    """Values of a dataset, as they are stored: of fixed size, in this file, in chunks as goniosim makes them.

    Parameters
    ----------
    found : h5py.Dataset
        Of a shape that was checked: so much memory is used.

    Returns
    -------
    ndarray
    """
    plan = found.id.get_create_plist()
    stored = found.id.get_storage_size()
    if plan.get_external_count() or plan.get_layout() not in (h5py.h5d.CONTIGUOUS, h5py.h5d.CHUNKED):
        raise ValueError(f"the values of {found.name} are not in the file itself")
    if found.dtype.hasobject:
        raise ValueError(f"the values of {found.name} are not of fixed size")
    n_bytes = math.prod(found.shape) * found.dtype.itemsize
    most = _MOST_COMPRESSED * stored if plan.get_layout() == h5py.h5d.CHUNKED else stored
    if n_bytes > most + _NO_STORAGE or stored > found.file.id.get_filesize():
        raise ValueError(f"{found.name} claims {n_bytes} bytes and has {stored}")
    if plan.get_layout() == h5py.h5d.CHUNKED:
        return _read_chunks(found, plan)
    return np.asarray(found[()])


def chunk_shape(shape: tuple[int, ...]) -> tuple[int, ...]:
    """Chunks in which a dataset is written: one slice in each."""
    return (1,) * (len(shape) - 2) + shape[-2:]


def _read_chunks(found: h5py.Dataset, plan: h5py.h5p.PropDCID) -> np.ndarray:
    filters = tuple(plan.get_filter(number)[0] for number in range(plan.get_nfilters()))
    shape = chunk_shape(found.shape)
    if filters != _FILTERS or found.chunks != shape or 0 in shape:
        raise ValueError(f"the values of {found.name} are not stored as goniosim stores them")
    values = np.empty(found.shape, found.dtype)
    outer = found.shape[: max(0, len(shape) - 2)]
    for index in np.ndindex(*outer):
        start = (*index, *(0,) * (len(shape) - len(outer)))
        skipped, raw = found.id.read_direct_chunk(start)
        values[index] = _decoded(found, skipped, raw, shape)
    return values


def _decoded(found: h5py.Dataset, skipped: int, raw: bytes, shape: tuple[int, ...]) -> np.ndarray:
    """One chunk: inflated no further than it should be, and its bytes put back into order."""
    size = found.dtype.itemsize
    n_bytes = math.prod(shape) * size
    if not skipped & 1 << _FILTERS.index(_FLETCHER32):
        raw = raw[:-_CHECKSUM_BYTES]
    if not skipped & 1 << _FILTERS.index(_DEFLATE):
        inflater = zlib.decompressobj()
        try:
            raw = inflater.decompress(raw, n_bytes + 1)
        except zlib.error as error:
            raise ValueError(f"the values of {found.name} cannot be decompressed: {error}") from None
        if not inflater.eof:
            raise ValueError(f"the values of {found.name} cannot be decompressed to {n_bytes} bytes")
    if len(raw) != n_bytes:
        raise ValueError(f"the values of {found.name} have {len(raw)} bytes in a chunk, not {n_bytes}")
    if skipped & 1 << _FILTERS.index(_SHUFFLE):
        return np.frombuffer(raw, found.dtype).reshape(shape)
    ordered = np.ascontiguousarray(np.frombuffer(raw, np.uint8).reshape(size, -1).T)
    return ordered.view(found.dtype).reshape(shape)
