"""Reading integrated models, one at a time: a study holds more than fits into memory."""

import contextlib
import hashlib
from dataclasses import dataclass

import h5py
import numpy as np

from goniosim.errors import ForeignFileError, NewerSchemaError
from goniosim.result import Cells, Component
from goniosim.store import userblock
from goniosim.store.decoding import attributes, cells, decoding, find, find_shaped, plain, text, values
from goniosim.store.layout import SCALES
from goniosim.store.models import checksums
from goniosim.store.models.layout import (
    COMPONENTS,
    FILETYPE,
    NOT_PROVENANCE,
    SCHEMA_VERSION,
    SHARED,
    VALUES,
    describe,
)

REMEDY = "restore it from a copy or compare again"
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_UNREADABLE = "unreadable"


@dataclass(frozen=True)
class ModelEntry:
    """What a file tells of a model without its slices.

    Attributes
    ----------
    label : str
        Name of the model with its options: ``belcour18_forward[jacobian=snell]``.
    model, options : str
        The two apart.
    components : dict of str to bool
        Whether some energy of the component leaves in exactly one direction.
    """

    label: str
    model: str
    options: str
    components: dict[str, bool]


@dataclass(frozen=True)
class MaterialEntry:
    """What a file tells of a material.

    Attributes
    ----------
    name, config_yaml, config_hash : str
        Of the result that was compared.
    main_component : str
        The component by which the models were ranked.
    theta_deg, phi_deg : ndarray, shape (M,)
    rays : ndarray of int64, shape (M,)
        Of the simulation.
    channels : list of str
    cells : goniosim.result.Cells
    models : tuple of ModelEntry
    """

    name: str
    config_yaml: str
    config_hash: str
    main_component: str
    theta_deg: np.ndarray
    phi_deg: np.ndarray
    rays: np.ndarray
    channels: list[str]
    cells: Cells
    models: tuple[ModelEntry, ...]


class ModelsFile:
    """An open file of integrated models, from `open_models`.

    Attributes
    ----------
    schema_version : str
    provenance : dict of str to str
    materials : tuple of str
        Names, in the order of comparison.
    """

    def __init__(self, path, file):
        self._path = path
        self._file = file
        header = attributes(file)
        self.schema_version = header["schema_version"]
        self.provenance = {
            name: value for name, value in header.items() if name not in NOT_PROVENANCE and isinstance(value, str)
        }
        self.materials = _listed(file, "materials", self.schema_version)

    def material(self, name):
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
            group = self._file[name]
            config_yaml = text(group, "config_yaml")
            if text(group, "name") != name:
                raise ValueError(f"the material {name} calls itself {text(group, 'name')}")
            if self.schema_version != "1.0" and _sha256(config_yaml) != text(group, "config_yaml_sha256"):
                raise ValueError(f"the scene of {name} does not match its digest")
            sizes = {dim: len(find(group, scale)) for dim, scale in SCALES.items() if dim != "rays"}
            shared = {entry.path: values(find_shaped(group, entry.path, entry, sizes), entry) for entry in SHARED}
            models = tuple(
                _model_entry(group[label], label, sizes) for label in _listed(group, "models", self.schema_version)
            )
            return MaterialEntry(
                name=name,
                config_yaml=config_yaml,
                config_hash=text(group, "config_hash"),
                main_component=_main_component(group, models, self.schema_version),
                theta_deg=shared["incident/theta_deg"],
                phi_deg=shared["incident/phi_deg"],
                rays=shared["incident/rays"],
                channels=shared["channels/name"],
                cells=cells(group, shared.__getitem__),
                models=models,
            )

    def slices(self, material, model):
        """Read the slices of a model.

        Parameters
        ----------
        material : MaterialEntry
        model : ModelEntry

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
            }

    def verify(self):
        """Hold every dataset against its checksums: seconds for a gigabyte.

        Raises
        ------
        DamagedFileError
        """

        def check(_, node):
            # What a user added has perhaps no checksum, and is no concern of ours.
            if isinstance(node, h5py.Dataset) and node.fletcher32:
                checksums.verify(node)

        with decoding(self._path, REMEDY):
            # Comes once to what has several names.
            self._file.visititems(check)


@contextlib.contextmanager
def open_models(path):
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


def is_models_file(path):
    """Whether an existing file holds integrated models, of whatever version; False if it cannot be read."""
    return _filetype(path) == FILETYPE


def may_be_models_file(path):
    """As `is_models_file`, but True also for an HDF5 file too damaged to tell: results start differently."""
    return _filetype(path) in (FILETYPE, _UNREADABLE)


def _filetype(path):
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


def _foreign(path):
    return ForeignFileError(
        f"{path}: is not a file of integrated models; name a models.h5 that `goniosim compare` wrote"
    )


def _listed(group, name, version):
    """Names that an attribute lists, each of a group that is there."""
    if version == "1.0":
        # It had no lists, and nothing beside what was compared.
        return tuple(
            key
            for key, node in group.items()
            if isinstance(node, h5py.Group) and ("config_hash" in node.attrs or "model" in node.attrs)
        )
    names = tuple(text(group, name).splitlines())
    for each in names:
        if "/" in each or not isinstance(group.get(each), h5py.Group):
            raise ValueError(f"the group {each} of {group.name} is missing")
    return names


def _model_entry(group, label, sizes):
    found = {}
    for component in COMPONENTS:
        if f"{component}/{VALUES[0]}" in group:
            for name in VALUES:
                path = f"{component}/{name}"
                find_shaped(group, path, describe(path), sizes)
            found[component] = bool(group[component].attrs["contains_delta"])
    if not found:
        raise ValueError(f"the model {group.name} has no component")
    return ModelEntry(label, text(group, "model"), text(group, "options"), found)


def _main_component(group, models, version):
    if version == "1.0":
        return next(
            name for name in ("transmission", *COMPONENTS[1:]) if any(name in each.components for each in models)
        )
    return text(group, "main_component")


def _sha256(words):
    return hashlib.sha256(words.encode()).hexdigest()
