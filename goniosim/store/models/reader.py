"""Reading integrated models, one at a time: a study holds more than fits into memory."""

import contextlib
from collections.abc import Iterator

import h5py

from goniosim.errors import ForeignFileError, NewerSchemaError
from goniosim.result import Component
from goniosim.store import userblock
from goniosim.store.decoding import attributes, decoding, plain, text, values
from goniosim.store.models import checksums
from goniosim.store.models.contents import MaterialEntry, ModelEntry, listed, read_material
from goniosim.store.models.layout import FILETYPE, NOT_PROVENANCE, SCHEMA_VERSION, VALUES, describe
from goniosim.writing import StrPath

REMEDY = "restore it from a copy or compare again"
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_UNREADABLE = "unreadable"


class ModelsFile:
    """An open file of integrated models, from `open_models`.

    Attributes
    ----------
    schema_version : str
    provenance : dict of str to str
    materials : tuple of str
        Names, in the order of comparison.
    """

    def __init__(self, path: StrPath, file: h5py.File) -> None:
        self._path = path
        self._file = file
        header = attributes(file)
        self.schema_version = header["schema_version"]
        self.provenance = {
            name: value for name, value in header.items() if name not in NOT_PROVENANCE and isinstance(value, str)
        }
        self.materials = listed(file, "materials", self.schema_version)

    def material(self, name: str) -> MaterialEntry:
        """Read what describes a material, and make sure that the slices of its models are there.

        Parameters
        ----------
        name : str
            One of `materials`.

        Returns
        -------
        MaterialEntry

        Raises
        ------
        DamagedFileError
        """
        with decoding(self._path, REMEDY):
            return read_material(self._file[name], name, self.schema_version)

    def slices(self, material: MaterialEntry, model: ModelEntry, component: str = "") -> dict[str, Component]:
        """Read the slices of a model.

        Parameters
        ----------
        material : MaterialEntry
        model : ModelEntry
        component : str
            Only components whose names begin so.

        Returns
        -------
        dict of str to goniosim.result.Component

        Raises
        ------
        DamagedFileError
            Also when a checksum does not fit.
        """
        with decoding(self._path, REMEDY):
            group = self._file[material.name][model.label]
            return {
                name: Component(
                    **{each: values(group[f"{name}/{each}"], describe(f"{name}/{each}")) for each in VALUES},
                    contains_delta=contains_delta,
                )
                for name, contains_delta in model.components.items()
                if name.startswith(component)
            }

    def verify(self) -> None:
        """Hold every dataset against its checksums: seconds for a gigabyte.

        Raises
        ------
        DamagedFileError
        """

        def check(_: str, node: h5py.Group | h5py.Dataset) -> None:
            # What a user added has perhaps no checksum, and is no concern of ours.
            if isinstance(node, h5py.Dataset) and node.fletcher32:
                checksums.verify(node)

        with decoding(self._path, REMEDY):
            # Comes once to what has several names.
            self._file.visititems(check)


@contextlib.contextmanager
def open_models(path: StrPath) -> Iterator[ModelsFile]:
    """Open a file of integrated models, for a ``with`` statement.

    Parameters
    ----------
    path : path-like

    Yields
    ------
    ModelsFile

    Raises
    ------
    ForeignFileError
        If the file is missing or holds no integrated models.
    DamagedFileError
        If it was cut off or its table of contents was altered. Damage to the rest is found when that is
        read, or by `ModelsFile.verify`.
    NewerSchemaError
        If its major schema version is newer than this goniosim reads.
    """
    with userblock.open_regular(path) as stream, contextlib.ExitStack() as stack:
        if stream.read(len(_SIGNATURE)) != _SIGNATURE:
            raise _foreign(path)
        with decoding(path, REMEDY):
            file = stack.enter_context(h5py.File(stream, "r"))
            if plain(file.attrs.get("filetype")) != FILETYPE:
                raise _foreign(path)
            version = text(file, "schema_version")
            if int(version.split(".")[0]) > int(SCHEMA_VERSION.split(".")[0]):
                raise NewerSchemaError(
                    f"{path}: follows schema {version} of integrated models, "
                    f"but this goniosim reads schema {SCHEMA_VERSION}; update goniosim"
                )
            opened = ModelsFile(path, file)
        yield opened


def is_models_file(path: StrPath) -> bool:
    """Whether an existing file holds integrated models, of whatever version; False if it cannot be read."""
    return _filetype(path) == FILETYPE


def may_be_models_file(path: StrPath) -> bool:
    """As `is_models_file`, but True also for an HDF5 file too damaged to tell: results start differently."""
    return _filetype(path) in (FILETYPE, _UNREADABLE)


def _filetype(path: StrPath) -> object:
    try:
        with userblock.open_regular(path) as stream:
            if stream.read(len(_SIGNATURE)) != _SIGNATURE:
                return None
            try:
                with h5py.File(stream, "r") as file:
                    return plain(file.attrs.get("filetype"))
            except (OSError, RuntimeError, LookupError, ValueError):
                return _UNREADABLE
    except (ForeignFileError, OSError):
        return None


def _foreign(path: StrPath) -> ForeignFileError:
    return ForeignFileError(
        f"{path}: is not a file of integrated models; name a models.h5 that `goniosim compare` wrote"
    )
