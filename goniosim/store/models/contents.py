"""What a file of integrated models tells without its slices: its materials, and the models of each.

Whatever is not as described raises a ValueError.
"""

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import h5py
import numpy as np

from goniosim.result import Cells, Component
from goniosim.store import access, validation
from goniosim.store.decoding import cells, shaped, values
from goniosim.store.manifest import Manifest, NoManifest
from goniosim.store.models.layout import COMPONENTS, SHARED, VALUES, describe


@dataclass(frozen=True)
class Source:
    """An open file, what in it is ours, and the version of its schema."""

    file: h5py.File
    ours: Manifest | NoManifest
    version: str


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


ENTRY = (
    validation.Rule(
        "the name of a material", "be usable as a file name", lambda entry: validation.is_file_name(entry.name)
    ),
    validation.Rule("config_hash", "be 64 hexadecimal digits", lambda entry: validation.is_hash(entry.config_hash)),
    validation.Rule(
        "a model",
        "be called NAME or NAME[OPTIONS], in plain letters",
        lambda entry: all(map(_is_well_named, entry.models)),
    ),
    validation.Rule(
        "main_component",
        "be one of every model",
        lambda entry: all(any(map(_is_within(entry.main_component), model.components)) for model in entry.models),
    ),
)


def read_material(source: Source, name: str) -> MaterialEntry:
    """Read what describes a material, and make sure that the slices of its models are there.

    Parameters
    ----------
    source : Source
    name : str
        By which the file lists it.

    Returns
    -------
    MaterialEntry
    """
    group = access.group(source.file, name)
    config_yaml = access.text(group, "config_yaml")
    if access.text(group, "name") != name:
        raise ValueError(f"the material {name} calls itself {access.text(group, 'name')!r}")
    if source.version == "1.1" and hashlib.sha256(config_yaml.encode()).hexdigest() != access.text(
        group, "config_yaml_sha256"
    ):
        raise ValueError(f"the scene of {name} does not match its digest")
    scene = validation.scene_of(config_yaml)
    sizes = validation.sizes_of(scene)
    shared = {entry.path: values(shaped(group, entry.path, entry, sizes), entry) for entry in SHARED}
    models = tuple(_model(source, f"{name}/{label}", label, sizes) for label in listed(source, name, "models"))
    material = MaterialEntry(
        name=name,
        config_yaml=config_yaml,
        config_hash=access.text(group, "config_hash"),
        main_component=_main_component(group, models, source.version),
        theta_deg=shared["incident/theta_deg"],
        phi_deg=shared["incident/phi_deg"],
        rays=shared["incident/rays"],
        channels=shared["channels/name"],
        cells=cells(group, shared.__getitem__),
        models=models,
    )
    validation.check(ENTRY, material)
    validation.check(validation.GEOMETRY, material, scene)
    return material


def read_slices(source: Source, material: MaterialEntry, model: ModelEntry, component: str) -> dict[str, Component]:
    """Read the slices of a model, of the components whose names begin with ``component``."""
    group = access.group(source.file, f"{material.name}/{model.label}")
    directions, rows, columns = material.cells.valid.shape
    sizes = {"direction": directions, "channel": len(material.channels), "row": rows, "column": columns}

    def read(path: str) -> Any:
        entry = describe(path)
        return values(shaped(group, path, entry, sizes), entry)

    return {
        name: Component(**{each: read(f"{name}/{each}") for each in VALUES} | {"contains_delta": contains_delta})
        for name, contains_delta in model.components.items()
        if name.startswith(component)
    }


def listed(source: Source, path: str, name: str) -> tuple[str, ...]:
    """Names that an attribute lists, each of a group that is there."""
    if source.version == "1.0":
        # It had no lists, and nothing beside what was compared.
        key = "model" if path else "config_hash"
        group = access.group(source.file, path)
        return tuple(each for each in group if access.has_attribute(access.node(group, each), key))
    names = tuple(access.text(access.group(source.file, path), name).splitlines())
    for each in names:
        if "/" in each or not each:
            raise ValueError(f"{name} lists {each!r}, which is no name of a group")
        access.group(source.file, f"{path}/{each}".lstrip("/"))
    return names


def _model(source: Source, path: str, label: str, sizes: Mapping[str, int]) -> ModelEntry:
    group = access.group(source.file, path)
    found = {}
    for component in COMPONENTS:
        if source.ours.has(f"{path}/{component}/{VALUES[0]}"):
            for name in VALUES:
                shaped(group, f"{component}/{name}", describe(f"{component}/{name}"), sizes)
            found[component] = access.flag(access.group(group, component), "contains_delta")
    if not found:
        raise ValueError(f"the model {path} has no component")
    return ModelEntry(label, access.text(group, "model"), access.text(group, "options"), found)


def _main_component(group: h5py.Group, models: Sequence[ModelEntry], version: str) -> str:
    if version == "1.0":
        present = {name for model in models for name in model.components}
        return next((name for name in ("transmission", *COMPONENTS[1:]) if name in present), "")
    main = access.text(group, "main_component")
    if main not in COMPONENTS:
        raise ValueError(f"main_component is {main!r}")
    return main


def _is_within(main: str) -> Callable[[str], bool]:
    return lambda name: name.startswith(main)


def _is_well_named(model: ModelEntry) -> bool:
    options = f"[{model.options}]" if model.options else ""
    plain = validation.is_name(model.model) and validation.is_options(model.options)
    return plain and model.label == f"{model.model}{options}"
