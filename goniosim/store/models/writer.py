"""Writing integrated models material by material: for each material and model, groups as in the root of a result."""

import contextlib
import hashlib
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

import h5py
import numpy as np

from goniosim.errors import OutputError
from goniosim.result import Component, Result
from goniosim.store import seal
from goniosim.store.encoding import FORMAT, reserve_seal, write_dataset, write_manifest, write_text
from goniosim.store.kinds import MODELS
from goniosim.store.models.layout import COORDINATES, FILETYPE, FOLDERS, SCHEMA_VERSION, SHARED, VALUES, describe
from goniosim.store.opening import kind_of
from goniosim.store.writer import arrays
from goniosim.writing import Replacement, StrPath, explained

_SHARED_PATHS = {entry.path for entry in SHARED}
_MANTISSA_BITS = 52
_KEPT_BITS = 24


class ModelsWriter:
    """Writes ``models.h5``; it appears under its name only when committed.

    Parameters
    ----------
    path : path-like
        An earlier file of integrated models may stand there, but nothing else.
    provenance : dict of str to str
        Attributes of the root.

    Raises
    ------
    OutputError
        The file cannot be written.
    """

    def __init__(self, path: StrPath, provenance: Mapping[str, str]) -> None:
        _refuse_to_destroy(path)
        self._path = path
        self._replacement = Replacement(path)
        self._materials: dict[str, list[str]] = {}
        self._places: dict[bytes, str] = {}
        try:
            with self._explained():
                # The lock on the file in the making is ours already.
                self._file = h5py.File(self._replacement.temporary, "w", libver=FORMAT, locking=False)
                self._place = reserve_seal(self._file)
                for name, text in {"filetype": FILETYPE, "schema_version": SCHEMA_VERSION, **provenance}.items():
                    write_text(self._file, name, text)
        except BaseException:
            self._replacement.discard()
            raise

    def commit(self) -> None:
        """Put the finished file in place."""
        with self._explained():
            write_text(self._file, "materials", "\n".join(self._materials))
            for name, labels in self._materials.items():
                write_text(self._file[name], "models", "\n".join(labels))
            content_digest = write_manifest(self._file)
            self._file.close()
            with open(self._replacement.temporary, "r+b") as stream:
                digest = seal.digest(stream, self._place)
                length = stream.tell()
                stream.seek(self._place)
                stream.write(seal.make(MODELS, length, digest, content_digest))
                stream.flush()
                os.fsync(stream.fileno())
        self._replacement.commit()

    def discard(self) -> None:
        """Close and remove the file, unless it was committed."""
        # A full disk makes closing fail too; the file goes anyway.
        with contextlib.suppress(OSError, RuntimeError):
            self._file.close()
        self._replacement.discard()

    def add_material(self, result: Result, main_component: str) -> None:
        """Make the group of a material with its cells and directions.

        Parameters
        ----------
        result : goniosim.result.Result
        main_component : str
            The component by which the models are ranked.
        """
        self._materials[result.name] = []
        with self._explained():
            group = self._file.create_group(result.name)
            for name in ("name", "config_yaml", "config_hash"):
                write_text(group, name, getattr(result, name))
            write_text(group, "main_component", main_component)
            for path, values in arrays(result):
                if path in _SHARED_PATHS:
                    write_dataset(group, path, values, describe(path))
            write_text(group["cells"], "parametrization", result.cells.parametrization)

    def add_model(
        self, result: Result, label: str, attributes: Mapping[str, str], slices: Mapping[str, Component]
    ) -> None:
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
        self._materials[result.name].append(label)
        with self._explained():
            material = self._file[result.name]
            group = material.create_group(label)
            for name, text in attributes.items():
                write_text(group, name, text)
            _link_shared(material, group)
            for path, component in slices.items():
                # Many models share their direct reflection.
                digest = hashlib.sha256(result.name.encode() + component.energy.tobytes()).digest()
                # A link to `reflection` would bring along what else that model has below it.
                if digest in self._places and path != "reflection":
                    group[path] = self._file[self._places[digest]]
                    continue
                self._places[digest] = f"{group.name}/{path}"
                for name in VALUES:
                    write_dataset(
                        group, f"{path}/{name}", _rounded(getattr(component, name)), describe(f"{path}/{name}")
                    )
                group[path].attrs["contains_delta"] = np.int8(component.contains_delta)

    @contextlib.contextmanager
    def _explained(self) -> Iterator[None]:
        with explained(self._path):
            try:
                yield
            except RuntimeError as error:
                # What HDF5 says when it cannot flush.
                raise OSError(str(error)) from error


def _refuse_to_destroy(path: StrPath) -> None:
    if Path(path).exists() and kind_of(path)[0] is not MODELS:
        raise OutputError(
            f"{path}: exists and is not a file of integrated models, so it is not overwritten; "
            "write the report into another folder"
        )


def _link_shared(material: h5py.Group, group: h5py.Group) -> None:
    """Hard links to everything shared: the group then reads like the root of a result file."""
    for name in COORDINATES:
        group[name] = material[name]
    for folder in FOLDERS:
        linked = group.create_group(folder)
        for name, dataset in material[folder].items():
            linked[name] = dataset
    write_text(group["cells"], "parametrization", material["cells"].attrs["parametrization"].decode())


def _rounded(values: np.ndarray) -> np.ndarray:
    """Values with the lowest bits of their mantissa zero, rounded to nearest."""
    bits = np.ascontiguousarray(values).view(np.uint64)
    dropped = _MANTISSA_BITS - _KEPT_BITS + 1
    half = np.uint64(1 << (dropped - 1))
    mask = np.uint64(~((1 << dropped) - 1) & 0xFFFFFFFFFFFFFFFF)
    return ((bits + half) & mask).view(np.float64)
