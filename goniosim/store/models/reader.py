"""Reading integrated models, one at a time: a study holds more than fits into memory."""

import contextlib
from collections.abc import Iterator

import h5py

from goniosim.result import Component
from goniosim.store import access
from goniosim.store.kinds import MODELS
from goniosim.store.manifest import Manifest, NoManifest
from goniosim.store.models.contents import MaterialEntry, ModelEntry, Source, listed, read_material, read_slices
from goniosim.store.models.layout import NOT_PROVENANCE
from goniosim.store.opening import decoding, kind_of, opened, written_by
from goniosim.writing import StrPath


class ModelsFile:
    """An open file of integrated models, from `open_models`.

    Attributes
    ----------
    schema_version : str
    provenance : dict of str to str
    materials : tuple of str
        Names, in the order of comparison.
    """

    def __init__(self, path: StrPath, file: h5py.File, ours: Manifest | NoManifest) -> None:
        self._path = path
        header = {name: access.attribute(file, name) for name in ours.attributes("")}
        self.schema_version = access.text(file, "schema_version")
        self.provenance = {
            name: value for name, value in header.items() if name not in NOT_PROVENANCE and isinstance(value, str)
        }
        self._source = Source(file, ours, self.schema_version)
        self.materials = listed(self._source, "", "materials")

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
        with (
            decoding(self._path, MODELS.remedy),
            written_by(self.schema_version, self._path, MODELS),
        ):
            return read_material(self._source, name)

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
            Also when a number is out of range.
        """
        with (
            decoding(self._path, MODELS.remedy),
            written_by(self.schema_version, self._path, MODELS),
        ):
            return read_slices(self._source, material, model, component)


@contextlib.contextmanager
def open_models(path: StrPath) -> Iterator[ModelsFile]:
    """Open a file of integrated models, for a ``with`` statement, and check every byte of it.

    That takes a second for a gigabyte. Warns with `goniosim.errors.AnnotatedFileWarning` if something was added
    to the file after it was written.

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
        If it was truncated or altered since it was written. What no such file can say is found when it is read.
    NewerSchemaError
        If its major schema version is newer than this goniosim reads.
    """
    with opened(path, MODELS) as (file, ours):
        with decoding(path, MODELS.remedy):
            models = ModelsFile(path, file, ours)
        yield models


def is_models_file(path: StrPath) -> bool:
    """Whether an existing file holds integrated models, of whatever version; False if it cannot be read."""
    return kind_of(path) == (MODELS, True)


def may_be_models_file(path: StrPath) -> bool:
    """As `is_models_file`, but True also for one that is damaged."""
    return kind_of(path)[0] is MODELS
