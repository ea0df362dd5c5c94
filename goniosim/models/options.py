"""Options of the models: frozen dataclasses whose fields carry their allowed values and meaning."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from goniosim.errors import ConfigError
from goniosim.scene.problems import closest, listed

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


@dataclasses.dataclass(frozen=True)
class OptionInfo:
    """One option of a model: name, default, allowed values, and what it decides."""

    name: str
    default: object
    values: tuple[Any, ...]
    meaning: str


def option(values: tuple[Any, ...], meaning: str) -> Any:
    """A field of an options dataclass; the first of ``values`` is the default."""
    return dataclasses.field(default=values[0], metadata={"values": values, "meaning": meaning})


def masking_option() -> Any:
    """How the masking of light and view combine; the same choice in every model."""
    return option(
        ("separable", "correlated"),
        "Smith masking G1(l) G1(v) of Walter et al. 2007, or height-correlated",
    )


def describe(options: type[DataclassInstance]) -> list[OptionInfo]:
    """List the options of an options dataclass.

    Returns
    -------
    list of OptionInfo
    """
    return [
        OptionInfo(field.name, field.default, field.metadata["values"], field.metadata["meaning"])
        for field in dataclasses.fields(options)
    ]


def parse_options(name: str, options: type[DataclassInstance], given: object) -> Any:
    """Check the options given for a model.

    Parameters
    ----------
    name : str
        Of the model, for the message.
    options : type
        Options dataclass of the model.
    given : mapping of str, instance of ``options``, or None
        Values may be text, as on a command line.

    Returns
    -------
    instance of ``options``

    Raises
    ------
    ConfigError
        With one line for each unknown option or value.
    """
    if given is None:
        given = {}
    if dataclasses.is_dataclass(given) and not isinstance(given, type):
        given = dataclasses.asdict(given)
    if not isinstance(given, Mapping):
        raise ConfigError(f"model {name}: options must be a mapping of names to values [got {given!r}]")
    known = {info.name: info for info in describe(options)}
    accepted: dict[str, Any] = {}
    problems: list[str] = []
    for key, value in given.items():
        if key not in known:
            problems.append(f"model {name}: has no option {key!r}; {_choice(key, list(known))}")
            continue
        values = {str(allowed).lower(): allowed for allowed in known[key].values}
        if str(value).lower() in values:
            accepted[key] = values[str(value).lower()]
        else:
            problem = f"model {name}: option {key}: {_choice(str(value), list(values))} [got {value!r}]"
            problems.append(problem)
    if problems:
        raise ConfigError(problems)
    return options(**accepted)


def _choice(word: object, known: list[str]) -> str:
    guess = closest(word, known)
    return f"choose {listed(known, 'or')}" + (f" (did you mean {guess}?)" if guess else "")
