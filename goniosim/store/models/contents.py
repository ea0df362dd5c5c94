"""What a file of integrated models tells without its slices: its materials, and the models of each.

Whatever is not as described raises a ValueError or a LookupError, see `goniosim.store.decoding`.
"""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import h5py
import numpy as np

from goniosim.result import Cells
from goniosim.store.decoding import cells, find, find_shaped, text, values
from goniosim.store.layout import SCALES
from goniosim.store.models.layout import COMPONENTS, SHARED, VALUES, describe


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


def read_material(group: h5py.Group, name: str, version: str) -> MaterialEntry:
    """Read what describes a material, and make sure that the slices of its models are there.

    Parameters
    ----------
    group : h5py.Group
    name : str
        By which the file lists it.
    version : str
        Of the schema.

    Returns
    -------
    MaterialEntry
    """
    config_yaml = text(group, "config_yaml")
    if text(group, "name") != name:
        raise ValueError(f"the material {name} calls itself {text(group, 'name')}")
    if version != "1.0" and hashlib.sha256(config_yaml.encode()).hexdigest() != text(group, "config_yaml_sha256"):
        raise ValueError(f"the scene of {name} does not match its digest")
    sizes = {dim: len(find(group, scale)) for dim, scale in SCALES.items() if dim != "rays"}
    shared = {entry.path: values(find_shaped(group, entry.path, entry, sizes), entry) for entry in SHARED}
    models = tuple(_model(group[label], label, sizes) for label in listed(group, "models", version))
    return MaterialEntry(
        name=name,
        config_yaml=config_yaml,
        config_hash=text(group, "config_hash"),
        main_component=_main_component(group, models, version),
        theta_deg=shared["incident/theta_deg"],
        phi_deg=shared["incident/phi_deg"],
        rays=shared["incident/rays"],
        channels=shared["channels/name"],
        cells=cells(group, shared.__getitem__),
        models=models,
    )


def listed(group: h5py.Group, name: str, version: str) -> tuple[str, ...]:
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


def _model(group: h5py.Group, label: str, sizes: Mapping[str, int]) -> ModelEntry:
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


def _main_component(group: h5py.Group, models: Sequence[ModelEntry], version: str) -> str:
    if version == "1.0":
        present = {name for model in models for name in model.components}
        return next((name for name in ("transmission", *COMPONENTS[1:]) if name in present), "")
    main = text(group, "main_component")
    for model in models:
        if not any(name.startswith(main) for name in model.components):
            raise ValueError(f"the model {model.label} lacks the main component {main}")
    return main
