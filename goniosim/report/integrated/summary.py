"""What a file of integrated models holds, as text for a person and as plain data for a program."""

from ...store.models.layout import FILETYPE
from .. import text


def description(models):
    """Describe a file of integrated models: its materials, the models, and where it came from.

    Parameters
    ----------
    models : goniosim.store.ModelsFile

    Returns
    -------
    str
    """
    materials = [models.material(name) for name in models.materials]
    blocks = [
        [f"Integrated models of {_number(len(materials), 'material')}, schema {models.schema_version}"],
        ["Materials", *_material_lines(materials)],
        ["Models", *_model_lines(materials)],
        ["Origin", *text.pairs(models.provenance)],
    ]
    return "\n\n".join("\n".join(lines) for lines in blocks)


def as_data(models):
    """Everything `description` tells, as plain data that JSON can hold.

    Parameters
    ----------
    models : goniosim.store.ModelsFile

    Returns
    -------
    dict
    """
    return {
        "filetype": FILETYPE,
        "schema_version": models.schema_version,
        "materials": [_material_data(models.material(name)) for name in models.materials],
        "provenance": dict(models.provenance),
    }


def _material_lines(materials):
    rows = [
        [
            material.name,
            material.main_component,
            _slices(material),
            " ".join(material.channels),
            text.counts(material.rays),
            str(len(material.models)),
        ]
        for material in materials
    ]
    header = ["material", "main component", "slices", "channels", "rays of the\nsimulation", "models"]
    angles = {}
    for material in materials:
        angles.setdefault(", ".join(text.angles(material.theta_deg)), []).append(material.name)
    shown = [f"  incident theta [deg]: {each}{_of(names, materials)}" for each, names in angles.items()]
    return [*text.table(header, rows), *shown]


def _model_lines(materials):
    found = {}
    for material in materials:
        for entry in material.models:
            found.setdefault((entry.model, entry.options), []).append(entry)
    rows = []
    for (model, options), entries in found.items():
        components = dict.fromkeys(name for entry in entries for name in entry.components)
        rows.append([model, options or "default", ", ".join(components), f"{len(entries)} of {len(materials)}"])
    return text.table(["model", "options", "components", "materials"], rows)


def _material_data(material):
    rows, columns = material.cells.valid.shape[1:]
    return {
        "name": material.name,
        "main_component": material.main_component,
        "theta_deg": material.theta_deg.tolist(),
        "phi_deg": material.phi_deg.tolist(),
        "rays": material.rays.tolist(),
        "channels": list(material.channels),
        "slice": {"parametrization": material.cells.parametrization, "rows": rows, "columns": columns},
        "models": [
            {
                "label": entry.label,
                "model": entry.model,
                "options": entry.options,
                "components": {name: {"contains_delta": delta} for name, delta in entry.components.items()},
            }
            for entry in material.models
        ],
        "config_yaml": material.config_yaml,
        "config_hash": material.config_hash,
    }


def _slices(material):
    rows, columns = material.cells.valid.shape[1:]
    return f"{material.cells.parametrization}, {rows} x {columns}"


def _of(names, materials):
    return "" if len(names) == len(materials) else f"  ({_number(len(names), 'material')})"


def _number(count, noun):
    return f"{count} {noun}" + ("" if count == 1 else "s")
