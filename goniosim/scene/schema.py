"""JSON Schema of scene and study files, for editors that complete and check while typing.

It is kept in ``configs/scene.schema.json``; `schema_text` is the content of that file.
"""

import json
from typing import Any

from goniosim.scene.model import FileName, Scene

DRAFT = "https://json-schema.org/draft/2020-12/schema"
REFERENCE = {"type": "string", "pattern": r"\$\{[^{}]+\}"}
AXIS_VALUE = {
    "anyOf": [
        {"type": ["number", "string", "boolean"]},
        {"type": "array", "items": {"type": ["number", "string", "boolean"]}},
    ]
}


def json_schema() -> dict[str, Any]:
    """Describe the format of scene and study files.

    The order of layers and the meaning of ``${...}`` go beyond what a schema
    can say; `load_scenes` checks them.

    Returns
    -------
    dict
        JSON Schema, draft 2020-12.
    """
    scene = _tidy(Scene.model_json_schema())
    parts = scene.pop("$defs")
    templates = {f"{name}Template": _templated(part) for name, part in parts.items()}
    shared = {key: {"$ref": f"#/$defs/{key.title()}Template"} for key in ("incident", "slice", "simulation")}
    study_file = {
        "description": "Several materials, measured alike.",
        "type": "object",
        "properties": {"study": {"$ref": "#/$defs/Study"}, **shared},
        "required": ["study", "incident"],
        "additionalProperties": False,
    }
    return {
        "$schema": DRAFT,
        "title": "goniosim scene",
        "type": "object",
        "if": {"required": ["study"]},
        "then": {"$ref": "#/$defs/StudyFile"},
        "else": {"$ref": "#/$defs/Scene"},
        "$defs": {**parts, "Scene": scene, **templates, "Study": _study(), "StudyFile": study_file},
    }


def schema_text() -> str:
    """The schema as it stands in ``configs/scene.schema.json``.

    Returns
    -------
    str
    """
    return json.dumps(json_schema(), indent=2) + "\n"


def _study() -> dict[str, Any]:
    name = {
        **FileName().json_schema(),
        "description": "Name of the study and of the folder of its results.",
    }
    listed = {
        "type": "object",
        "properties": {
            "name": name,
            "materials": {
                "type": "array",
                "items": {"$ref": "#/$defs/Material"},
                "minItems": 1,
                "description": "The materials, one by one.",
            },
        },
        "required": ["name", "materials"],
        "additionalProperties": False,
    }
    axis = {
        "type": "array",
        "minItems": 1,
        "items": {"anyOf": [{"type": "object", "additionalProperties": AXIS_VALUE}, AXIS_VALUE]},
    }
    crossed = {
        "type": "object",
        "properties": {
            "name": name,
            "cross": {
                "type": "object",
                "additionalProperties": axis,
                "minProperties": 1,
                "description": "Axes: every combination of their entries makes a material.",
            },
            "material": {"$ref": "#/$defs/MaterialTemplate"},
        },
        "required": ["name", "cross", "material"],
        "additionalProperties": False,
    }
    return {"if": {"required": ["materials"]}, "then": listed, "else": crossed}


def _tidy(schema: Any) -> Any:
    """Drop the titles that only repeat a key, and the nulls that stand for an absent key."""
    if isinstance(schema, list):
        return [_tidy(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    kept = {
        key: _tidy(value)
        for key, value in schema.items()
        if not (key == "title" and isinstance(value, str)) and not (key == "default" and value is None)
    }
    kept.pop("discriminator", None)
    return kept


def _templated(schema: dict[str, Any]) -> dict[str, Any]:
    """Allow ``${...}`` wherever a number, a name or a list of numbers may stand."""
    if "$ref" in schema:
        return {**schema, "$ref": schema["$ref"] + "Template"}
    if "properties" in schema:
        inner = {key: _templated(value) for key, value in schema["properties"].items()}
        return {**schema, "properties": inner}
    if "oneOf" in schema:
        return {**schema, "oneOf": [_templated(option) for option in schema["oneOf"]]}
    if "const" in schema:
        return schema
    if schema.get("type") == "array":
        schema = {**schema, "items": _templated(schema["items"])}
        if "$ref" in schema["items"]:
            return schema
    about: dict[str, Any] = {key: schema[key] for key in ("description", "default") if key in schema}
    return {**about, "anyOf": [{key: value for key, value in schema.items() if key not in about}, REFERENCE]}
