"""The file of integrated models: for each material and model, groups as in the root of a result file."""

import contextlib
import hashlib
import os
import secrets
from pathlib import Path

import h5py
import numpy as np

from goniosim.errors import OutputError
from goniosim.store.layout import SCALES, describe
from goniosim.store.writer import _FORMAT, _arrays, _link_coordinates, _stored, _write_text

FILETYPE = "goniosim-models"
MODELS_VERSION = "1.0"

# What a model shares with the result it was integrated for; no audit, no cost.
_COORDINATES = ("direction", "channel", "row", "column")
_FOLDERS = ("incident", "channels", "cells")
_MANTISSA_BITS = 52
_KEPT_BITS = 24


class ModelSlicesFile:
    """Writes ``models.h5`` material by material; it appears under its name only when committed.

    Parameters
    ----------
    path : path-like
        Replaced if it exists.
    provenance : dict of str to str
        Attributes of the root.

    Raises
    ------
    OutputError
        The file cannot be written.
    """

    def __init__(self, path, provenance):
        self._path = Path(path)
        self._temporary = self._path.with_name(f".{self._path.name}.{secrets.token_hex(4)}.part")
        with self._explained():
            self._file = h5py.File(self._temporary, "w", libver=_FORMAT)
        self._paths = {}
        _write_text(self._file, "filetype", FILETYPE)
        _write_text(self._file, "schema_version", MODELS_VERSION)
        for name, text in provenance.items():
            _write_text(self._file, name, text)

    def commit(self):
        """Put the finished file in place."""
        with self._explained():
            self._file.close()
            with open(self._temporary, "rb") as stream:
                os.fsync(stream.fileno())
            os.replace(self._temporary, self._path)

    def discard(self):
        """Close and remove the file, unless it was committed."""
        # A full disk makes closing fail too; the file goes anyway.
        with contextlib.suppress(OSError, RuntimeError):
            self._file.close()
        with contextlib.suppress(OSError):
            os.unlink(self._temporary)

    def add_material(self, result):
        """Make the group of a material with its cells and directions.

        Parameters
        ----------
        result : goniosim.result.Result
        """
        with self._explained():
            group = self._file.create_group(result.name)
            for name in ("config_yaml", "config_hash", "name"):
                _write_text(group, name, getattr(result, name))
            for path, values in _arrays(result):
                if path in _COORDINATES or path.split("/")[0] in _FOLDERS:
                    _write(group, path, values, describe(path))
            _write_text(group["cells"], "parametrization", result.cells.parametrization)

    def add_model(self, result, label, attributes, slices):
        """Add the slices of one model.

        Parameters
        ----------
        result : goniosim.result.Result
            A material that was added.
        label : str
            Name of the model's group.
        attributes : dict of str to str
        slices : dict of str to goniosim.result.Component
            By name; ``reflection`` for one that holds both direct and internal paths. Values are
            stored with 24 significant bits: integration is not that accurate, and full mantissas
            hardly compress. Equal components of a material are stored once.
        """
        with self._explained():
            material = self._file[result.name]
            group = material.create_group(label)
            for name, text in attributes.items():
                _write_text(group, name, text)
            _link(material, group)
            for path, component in slices.items():
                # Many models share their direct reflection.
                digest = hashlib.sha256(result.name.encode() + component.energy.tobytes()).digest()
                if digest in self._paths:
                    group[path] = self._file[self._paths[digest]]
                    continue
                self._paths[digest] = f"{group.name}/{path}"
                for name in ("energy", "stderr", "bsdf", "bsdf_stderr"):
                    # Components are described alike; `reflection` as such is none of a result's.
                    entry = describe(f"transmission/{name}")
                    _write(group, f"{path}/{name}", _rounded(getattr(component, name)), entry)
                group[path].attrs["contains_delta"] = np.int8(component.contains_delta)

    @contextlib.contextmanager
    def _explained(self):
        try:
            yield
        except (OSError, RuntimeError) as error:
            raise OutputError(f"{self._path}: cannot be written: {error}; choose another place") from error


def _link(material, group):
    """Hard links to everything shared: the group then reads like the root of a result file."""
    for name in _COORDINATES:
        group[name] = material[name]
    for folder in _FOLDERS:
        linked = group.create_group(folder)
        for name, dataset in material[folder].items():
            linked[name] = dataset
    _write_text(group["cells"], "parametrization", material["cells"].attrs["parametrization"].decode())


def _write(group, path, values, entry):
    """Write a dataset below a group that looks like the root of a result file."""
    values = _stored(path, values, entry.dtype)
    chunks = (1,) * (values.ndim - 2) + values.shape[-2:]
    dataset = group.create_dataset(
        path, data=values, chunks=chunks, fletcher32=True, shuffle=True, compression=1, track_times=False
    )
    _write_text(dataset, "units", entry.unit)
    _write_text(dataset, "long_name", entry.meaning)
    if entry.dtype == "bool":
        _write_text(dataset, "dtype", "bool")
    if entry.dtype == "text":
        _write_text(dataset, "_Encoding", "utf-8")
    if entry.is_scale:
        dataset.make_scale(entry.dims[0])
        return
    for axis, dim in enumerate(entry.dims):
        dataset.dims[axis].attach_scale(group[SCALES[dim]])
    if "incident/" not in path:
        _link_coordinates(group, dataset, entry)


def _rounded(values):
    """Values with the lowest bits of their mantissa zero, rounded to nearest."""
    bits = np.ascontiguousarray(values).view(np.uint64)
    dropped = _MANTISSA_BITS - _KEPT_BITS + 1
    half = np.uint64(1 << (dropped - 1))
    mask = np.uint64(~((1 << dropped) - 1) & 0xFFFFFFFFFFFFFFFF)
    return ((bits + half) & mask).view(np.float64)
