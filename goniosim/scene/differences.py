"""What two scenes differ in, of all that determines the numbers of a result."""

from collections.abc import Iterator
from typing import Any

from goniosim.scene.layers import Layer, Part
from goniosim.scene.model import NOT_IDENTITY, Scene
from goniosim.scene.quantity import rgb

# Longer lists are not shown in full.
MOST = 12


def differences(there: Scene, asked: Scene) -> list[str]:
    """Name the fields in which a scene differs from the one that is asked for.

    Parameters
    ----------
    there : Scene
        That of a file.
    asked : Scene

    Returns
    -------
    list of str
        Such as ``layers[0].interface.alpha: 0.1 in the file, 0.2 asked for``; empty exactly when the scenes have the
        same `Scene.config_hash`.
    """
    if there.config_hash() == asked.config_hash():
        return []
    lines = list(_layer_lines(there, asked))
    for name in ("incident", "slice", "simulation"):
        lines += _field_lines(name, getattr(there, name), getattr(asked, name))
    return lines


def _layer_lines(there: Scene, asked: Scene) -> Iterator[str]:
    stacks = there.material.layers, asked.material.layers
    # Media in a row may be written as their sum.
    if _optics(there) == _optics(asked):
        return
    if len(stacks[0]) != len(stacks[1]):
        yield _line("layers", *(", ".join(map(_kind, stack)) for stack in stacks))
        return
    for number, (old, new) in enumerate(zip(*stacks, strict=True)):
        if _kind(old) != _kind(new):
            yield _line(f"layers[{number}]", _kind(old), _kind(new))
        else:
            name = "medium" if old.interface is None else "interface"
            yield from _field_lines(f"layers[{number}].{name}", getattr(old, name), getattr(new, name))


def _optics(scene: Scene) -> tuple[Any, ...]:
    material = scene.material
    faces = [[_as_triple(value) for value in face.model_dump().values()] for face in material.interfaces]
    return material.tau, faces


def _kind(layer: Layer) -> str:
    return "medium" if layer.interface is None else layer.interface.type


def _field_lines(path: str, there: Part, asked: Part) -> Iterator[str]:
    for name in type(there).model_fields:
        old, new = getattr(there, name), getattr(asked, name)
        if name in NOT_IDENTITY or _as_triple(old) == _as_triple(new):
            continue
        if name == "theta_deg":
            yield _angle_line(f"{path}.{name}", old, new)
        else:
            yield _line(f"{path}.{name}", _show(old), _show(new))


def _angle_line(path: str, there: tuple[float, ...], asked: tuple[float, ...]) -> str:
    if max(len(there), len(asked)) <= MOST:
        return _line(path, _show(there), _show(asked))
    if len(there) != len(asked):
        return _line(path, f"{len(there)} angles", f"{len(asked)} angles")
    number = next(i for i, (old, new) in enumerate(zip(there, asked, strict=True)) if old != new)
    return _line(f"{path}[{number}]", _show(there[number]), _show(asked[number]))


def _line(path: str, there: str, asked: str) -> str:
    return f"{path}: {there} in the file, {asked} asked for"


def _as_triple(value: Any) -> Any:
    return rgb(value) if isinstance(value, float) else value


def _show(value: Any) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, tuple):
        return "[" + ", ".join(map(_show, value)) + "]"
    return repr(value).removesuffix(".0") if isinstance(value, float) else str(value)
