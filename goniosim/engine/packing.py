"""Trees of arrays and plain values as bytes, and back: what an interrupted run needs to go on.

Data only: nothing in the bytes is executed, and what they say of themselves is checked before it is believed.
"""

import io
import json
import math
import zipfile

import numpy as np

_TREE, _ARRAY = "tree", "array"


def pack(tree):
    """Bytes of a tree.

    Parameters
    ----------
    tree : dict, list, tuple, ndarray, str, int, float, bool or None
        Keys are strings. Tuples come back as lists.

    Returns
    -------
    bytes
        The same for equal trees.
    """
    arrays = []
    text = json.dumps(_without_arrays(tree, arrays), allow_nan=False)
    found = io.BytesIO()
    # Not `np.savez`: it writes the time of day.
    with zipfile.ZipFile(found, "w") as archive:
        # HDF5 takes zeros at the end for padding.
        archive.comment = b"."
        archive.writestr(zipfile.ZipInfo(_TREE), text)
        for number, array in enumerate(arrays):
            with archive.open(zipfile.ZipInfo(str(number)), "w", force_zip64=True) as entry:
                np.lib.format.write_array(entry, array, allow_pickle=False)
    return found.getvalue()


def unpack(content):
    """The tree that `pack` made bytes of.

    Parameters
    ----------
    content : bytes-like

    Returns
    -------
    dict, list, ndarray, str, int, float, bool or None

    Raises
    ------
    ValueError
        If they are not such bytes.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            arrays = []
            for number in range(len(archive.namelist()) - 1):
                with archive.open(str(number)) as entry:
                    arrays.append(np.lib.format.read_array(entry, allow_pickle=False))
            return _with_arrays(json.loads(archive.read(_TREE)), arrays)
    except (zipfile.BadZipFile, KeyError, IndexError, TypeError, EOFError, RecursionError) as error:
        raise ValueError(f"not the state of a run: {error}") from error


def array(value, shape, dtype=float):
    """A copy of an array of a tree; a ValueError if it is none of that shape and type, or not finite.

    Parameters
    ----------
    value : object
    shape : tuple of int
        -1 for any length.
    dtype : type
    """
    fits = isinstance(value, np.ndarray) and value.dtype == dtype and value.ndim == len(shape)
    if not fits or any(length not in (-1, found) for length, found in zip(shape, value.shape, strict=True)):
        raise ValueError(f"not the state of this run: an array of shape {shape} is missing")
    if not np.isfinite(value).all():
        raise ValueError("not the state of this run: numbers that are not finite")
    return np.array(value, order="C")


def amount(value):
    """A number of a tree that is not negative; a ValueError or TypeError if it is none."""
    found = float(value)
    if not 0.0 <= found < math.inf:
        raise ValueError(f"not the state of this run: {found} of something")
    return found


def _without_arrays(tree, arrays):
    if isinstance(tree, np.ndarray):
        arrays.append(tree)
        return {_ARRAY: len(arrays) - 1}
    if isinstance(tree, dict):
        return {"dict": {key: _without_arrays(value, arrays) for key, value in tree.items()}}
    if isinstance(tree, list | tuple):
        return [_without_arrays(value, arrays) for value in tree]
    return tree.item() if isinstance(tree, np.generic) else tree


def _with_arrays(tree, arrays):
    if isinstance(tree, list):
        return [_with_arrays(value, arrays) for value in tree]
    if not isinstance(tree, dict):
        return tree
    if _ARRAY in tree:
        return arrays[tree[_ARRAY]]
    return {key: _with_arrays(value, arrays) for key, value in tree["dict"].items()}
