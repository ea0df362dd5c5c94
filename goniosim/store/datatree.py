"""A result as xarray sees its file: the same groups, names, axes, coordinates and attributes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from goniosim.result import Result
from goniosim.store.layout import SCALES, Dataset, angles_of, describe
from goniosim.store.writer import arrays, components_of, root_attributes

if TYPE_CHECKING:
    import xarray


def to_datatree(result: Result) -> xarray.DataTree:
    """Turn a result into a tree of labelled arrays.

    Parameters
    ----------
    result : Result

    Returns
    -------
    xarray.DataTree
        Equal to what ``xarray.open_datatree`` makes of the file of the result, but for the checksums of
        the file. The arrays are shared with the result, not copied.

    Raises
    ------
    ImportError
        xarray is not installed, or too old to have trees.
    """
    try:
        from xarray import Dataset as Group
        from xarray import DataTree
    except ImportError as error:
        message = "to_xarray needs xarray 2024.10 or newer, an optional part: pip install goniosim[xarray]"
        raise ImportError(message) from error
    variables = {path: _variable(values, describe(path)) for path, values in arrays(result)}
    attributes = _attributes(result)
    groups: dict[str, dict[str, Any]] = {path: {} for path in ["", *attributes]}
    coordinates: dict[str, dict[str, Any]] = {}
    for path, variable in variables.items():
        group, _, name = path.rpartition("/")
        entry = describe(path)
        scales = {dim: SCALES[dim] for dim in entry.dims} | angles_of(path, entry)
        coordinates.setdefault(group, {}).update({each: variables[scale] for each, scale in scales.items()})
        if not entry.is_scale:
            groups.setdefault(group, {})[name] = variable
    return DataTree.from_dict(
        {f"/{group}": Group(data, coordinates.get(group), attributes.get(group)) for group, data in groups.items()}
    )


def _variable(values: Any, entry: Dataset) -> tuple[tuple[str, ...], np.ndarray, dict[str, str]]:
    """Axes, values and attributes of a dataset."""
    dtype = {"text": str}.get(entry.dtype, entry.dtype)
    return entry.dims, np.asarray(values, dtype), {"units": entry.unit, "long_name": entry.meaning}


def _attributes(result: Result) -> dict[str, dict[str, Any]]:
    """Attributes of the groups that have some."""
    root = root_attributes(result).items()
    components = components_of(result.components)
    return {
        "": {name: np.uint64(value) if isinstance(value, int) else value for name, value in root},
        "cells": {"parametrization": result.cells.parametrization},
        "effects": {name: np.int8(called_for) for name, called_for in result.effects.items()},
        **{path: {"contains_delta": np.int8(component.contains_delta)} for path, component in components},
    }
