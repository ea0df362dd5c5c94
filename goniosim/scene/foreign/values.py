"""From the numbers of other tools to ours: each function gives None where there is nothing to work out."""

import math
from collections.abc import Callable, Mapping
from typing import Any

Siblings = Mapping[str, Any]

# Halves of an optical depth, as `normal` of `goniosim.scene.foreign.words` spells them.
_ABSORPTION = ("sigmaa", "sigmat", "mua", "absorption", "absorptioncoefficient", "extinction", "attenuation")
_THICKNESS = ("thickness", "depth", "d", "distance", "height", "length")


def unchanged(value: object, _: Siblings) -> object:
    """The value itself."""
    return value


def squared(value: object, _: Siblings) -> object:
    """Square of a number, or of each in a list."""
    return _each(value, _square)


def _square(roughness: float) -> float:
    if roughness < 0.0:
        raise ValueError("no roughness is negative")
    return roughness * roughness


def one_minus_squared(value: object, _: Siblings) -> object:
    """``(1 - x)^2`` of a number, or of each in a list."""
    return _each(value, lambda x: (1.0 - x) ** 2)


def minus_log(value: object, _: Siblings) -> object:
    """Natural logarithm with the sign changed, of a number or of each in a list."""
    return _each(value, lambda x: -math.log(x) + 0.0)


def absorption_times_thickness(_: object, siblings: Siblings) -> object:
    """Product of the absorption and the thickness that stand beside each other."""
    absorption, thickness = (
        next((siblings[word] for word in words if word in siblings), None) for words in (_ABSORPTION, _THICKNESS)
    )
    if isinstance(absorption, list):
        absorption, thickness = thickness, absorption
    if not isinstance(absorption, (int, float)) or not _is_number(absorption):
        return None
    factor = absorption
    return _each(thickness, lambda x: factor * x)


def as_list(value: object, _: Siblings) -> object:
    """A list of the one number, or the list itself."""
    return [value] if _is_number(value) else value


def degrees_as_list(value: object, siblings: Siblings) -> object:
    """Radians as a list of degrees."""
    return _each(as_list(value, siblings), math.degrees)


def as_target(value: object, _: Siblings) -> object:
    """A target of a relative error, which may be a percentage."""
    return {"relative_error": value} if isinstance(value, (int, float, str)) and not isinstance(value, bool) else None


def _each(value: object, function: Callable[[float], float]) -> object:
    if isinstance(value, list):
        items = [_each(item, function) for item in value]
        return None if any(item is None for item in items) else items
    try:
        return float(f"{function(value):.6g}") if isinstance(value, (int, float)) and _is_number(value) else None
    except (ValueError, OverflowError):
        return None


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)
