"""What a file must say for the rest of goniosim to rely on it, as rules: a stranger can write anything.

The types and ranges of single datasets stand in `goniosim.store.layout`; here is what ties them together.
"""

import functools
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from goniosim.errors import ConfigError
from goniosim.result import INTEGRATED
from goniosim.scene import CHANNELS, Scene, components, parse_scene
from goniosim.scene.model import FileName
from goniosim.sums import BLOCKS, block_starts, block_sums

# Each checkpoint comes after twice the work of the one before; a merged run may have more of them.
MAX_CHECKPOINTS = 100_000
MAX_BATCHES = 1024
# What says in the provenance that a result is of several runs.
JOINED = {"extended_from", "merged_seeds"}
_SUM = 1e-6
_ANGLE = 1e-9
# Smaller numbers have lost their digits.
_TINY = 1e-300

Header = Mapping[str, str | int]


@dataclass(frozen=True)
class Rule:
    """Something that must hold.

    Attributes
    ----------
    field : str
        Of the file.
    must : str
        How the sentence goes on: "be ...".
    holds : callable
        What is given to `check` is given to it.
    """

    field: str
    must: str
    holds: Callable[..., bool]


def check(rules: Sequence[Rule], *subjects: Any) -> None:
    """Raise a ValueError that names the first rule that does not hold."""
    for rule in rules:
        if not rule.holds(*subjects):
            raise ValueError(f"{rule.field} must {rule.must}")


def _word(pattern: str, low: int, high: int) -> Callable[[object], bool]:
    found = re.compile(f"{pattern}{{{low},{high}}}", re.ASCII)
    return lambda value: isinstance(value, str) and found.fullmatch(value) is not None


is_name = _word(r"[a-zA-Z0-9_]", 1, 80)
is_hash = _word(r"[0-9a-f]", 64, 64)
is_options = _word(r"[a-zA-Z0-9_=,.+ -]", 0, 400)


def is_version(value: object) -> bool:
    """Whether a value is a version of a schema."""
    return isinstance(value, str) and re.fullmatch(r"\d{1,6}\.\d{1,6}", value, re.ASCII) is not None


def is_file_name(value: object) -> bool:
    """Whether a name is one that a material may have: no path, no control character."""
    return isinstance(value, str) and re.fullmatch(FileName.pattern, value) is not None


def _are_texts(header: Header, *names: str) -> bool:
    return all(isinstance(header.get(name), str) for name in names)


HEADER = (
    Rule("name", FileName.rule.removeprefix("must "), lambda header: is_file_name(header.get("name"))),
    Rule("status", "be complete or partial", lambda header: header.get("status") in ("complete", "partial")),
    Rule("target_reached", "be 0 or 1, or absent", lambda header: header.get("target_reached", 0) in (0, 1)),
    Rule("seed", "be a whole number", lambda header: isinstance(header.get("seed"), int)),
    Rule("config_hash", "be 64 hexadecimal digits", lambda header: is_hash(header.get("config_hash"))),
    Rule("schema_version", "be MAJOR.MINOR", lambda header: is_version(header.get("schema_version"))),
    Rule(
        "config_yaml, created_utc and goniosim_version",
        "be texts",
        lambda header: _are_texts(header, "config_yaml", "created_utc", "goniosim_version"),
    ),
    Rule("estimator", "be a plain name", lambda header: is_name(header.get("estimator", "analog"))),
    Rule(
        "merged_seeds",
        "be whole numbers, or absent",
        lambda header: re.fullmatch(r"\d{1,19}(, \d{1,19})*", str(header.get("merged_seeds", 0)), re.ASCII) is not None,
    ),
    Rule("an attribute of the root", "have a plain name", lambda header: all(map(is_name, header))),
)

HEADER_AND_SCENE = (
    Rule("name", "be that in config_yaml", lambda header, scene: header["name"] == scene.material.name),
    Rule("seed", "be that in config_yaml", lambda header, scene: header["seed"] == scene.simulation.seed),
    Rule(
        "target_reached",
        "be there only if config_yaml has a target",
        lambda header, scene: "target_reached" not in header or scene.simulation.target is not None,
    ),
)

HEADER_AND_RESULT = (
    Rule(
        "the attribute estimator",
        "be that of the components",
        lambda header, result: header.get("estimator", result.estimator) == result.estimator,
    ),
)

# For whatever has directions, channels and cells: a result, or a material of a file of models.
GEOMETRY = (
    Rule(
        "incident/theta_deg",
        "be the angles in config_yaml",
        lambda it, scene: it.theta_deg.tolist() == list(scene.incident.theta_deg),
    ),
    Rule(
        "channels/name",
        "be different names of up to 40 printable characters",
        lambda it, scene: len(set(it.channels)) == len(it.channels) and all(map(_is_label, it.channels)),
    ),
    Rule("cells/row_edges", "go from 0 to 90 in equal steps", lambda it, scene: _is_even(it.cells.row_edges, 90.0)),
    Rule(
        "cells/column_edges",
        "go from 0 to 360 in equal steps",
        lambda it, scene: _is_even(it.cells.column_edges, 360.0),
    ),
    Rule(
        "cells/parametrization",
        "be that in config_yaml",
        lambda it, scene: it.cells.parametrization == scene.slice.parametrization,
    ),
    Rule(
        "cells/solid_angle",
        "sum to 2 pi in each direction",
        lambda it, scene: np.allclose(it.cells.solid_angle.sum(axis=(1, 2)), 2.0 * np.pi, rtol=_SUM, atol=0.0),
    ),
    Rule(
        "cells/projected_solid_angle",
        "sum to pi in each direction",
        lambda it, scene: np.allclose(it.cells.projected_solid_angle.sum(axis=(1, 2)), np.pi, rtol=_SUM, atol=0.0),
    ),
)

RESULT = (
    Rule(
        "incident/rays",
        "be those in config_yaml, fewer if status is partial or a target decides, more of replicates or several runs",
        lambda result, scene: _are_asked_for(result, scene.simulation),
    ),
    Rule(
        "reflection and transmission",
        "be there as the scene calls for them",
        lambda result, scene: set(components(scene)) <= result.components.keys(),
    ),
    Rule(
        "COMPONENT/order_N",
        "be there for sampled components as simulation.orders in config_yaml asks for",
        lambda result, scene: all(
            set(component.orders) == _orders_of(name, scene) for name, component in result.components.items()
        ),
    ),
    Rule(
        "COMPONENT/estimator",
        "be a plain name for each direction, and `integrated` for reflection/direct alone",
        lambda result, scene: all(
            len(part.estimator) == len(result.theta_deg)
            and all(map(is_name, part.estimator))
            and {name == INTEGRATED for name in part.estimator} == {path.startswith("reflection/direct")}
            for path, part in _parts(result)
        ),
    ),
    Rule(
        "COMPONENT/hits",
        "be there for components of independent paths, and only for them",
        lambda result, scene: all(
            (part.hits is not None) == all(name == "analog" for name in part.estimator) for _, part in _parts(result)
        ),
    ),
    Rule(
        "COMPONENT/uncertain",
        "be there for sampled components, and only for them",
        lambda result, scene: all((part.uncertain is not None) == part.sampled for _, part in _parts(result)),
    ),
    Rule(
        "COMPONENT/albedo and albedo_stderr",
        "be there, and albedo be the sum of energy",
        lambda result, scene: all(
            part.albedo is not None
            and part.albedo_stderr is not None
            and np.allclose(part.energy.sum(axis=(2, 3)), part.albedo, rtol=_SUM, atol=_SUM)
            for _, part in _parts(result)
        ),
    ),
    Rule(
        "COMPONENT/batches",
        "be two or more, with the mean of them the energy in the blocks, or 0 for independent paths",
        lambda result, scene: all(_are_batches(part) for _, part in _parts(result) if part.batches is not None),
    ),
    Rule(
        "COMPONENT/paths",
        "be no fewer than incident/rays",
        lambda result, scene: all(
            part.paths is None or bool((part.paths >= result.rays).all()) for _, part in _parts(result)
        ),
    ),
    Rule(
        "COMPONENT/energy",
        "sum to what the audit says of the component, if the paths are its own",
        lambda result, scene: all(
            _is_audited(component, _audited(result, name)) for name, component in result.components.items()
        ),
    ),
    Rule(
        "COMPONENT/bsdf",
        "be the energy over the projected solid angle in valid cells, and 0 elsewhere",
        lambda result, scene: all(_is_averaged(part, result.cells) for _, part in _parts(result)),
    ),
    Rule("audit", "sum to 1 wherever rays were traced", lambda result, scene: _is_balanced(result)),
    Rule(
        "cost",
        "not decrease from one checkpoint to the next",
        lambda result, scene: all(
            (np.diff(each, axis=1) >= 0.0).all()
            for each in (result.cost.rays, result.cost.seconds, result.cost.cpu_seconds)
        ),
    ),
    Rule(
        "cost/error_SAMPLED",
        "be there for each sampled component",
        lambda result, scene: result.components.keys() - {"reflection/direct"} <= result.cost.error.keys(),
    ),
    Rule(
        "state",
        "be there only if status is partial",
        lambda result, scene: result.state is None or result.status == "partial",
    ),
    Rule("effects", "have plain names", lambda result, scene: all(map(is_name, result.effects))),
)


@functools.lru_cache(maxsize=8)
def scene_of(config_yaml: str) -> Scene:
    """The scene in a file; a ValueError with its first mistake if there is none."""
    try:
        return parse_scene(config_yaml, "config_yaml")
    except ConfigError as error:
        raise ValueError(error.problems[0]) from None


def sizes_of(scene: Scene) -> dict[str, int]:
    """Lengths of the dimensions that a scene determines."""
    rows, columns = scene.slice.rows, scene.slice.columns
    return {
        "direction": len(scene.incident.theta_deg),
        "channel": len(CHANNELS),
        "row": rows,
        "column": columns,
        "row_edges": rows + 1,
        "column_edges": columns + 1,
        "row_block": len(block_starts(rows, BLOCKS[0])),
        "column_block": len(block_starts(columns, BLOCKS[1])),
    }


def _orders_of(component: str, scene: Scene) -> set[str]:
    """Names of the orders of a component: light that passes meets the top interface once or more, other light twice."""
    highest = scene.simulation.orders
    if highest is None or component == "reflection/direct":
        return set()
    lowest = 1 if component == "transmission" else 2
    return {*(f"order_{number}" for number in range(lowest, highest + 1)), f"order_{highest + 1}_and_more"}


def _is_label(text: str) -> bool:
    return 0 < len(text) <= 40 and text.isprintable()


def _is_even(edges: np.ndarray, end: float) -> bool:
    return np.allclose(edges, np.linspace(0.0, end, len(edges)), rtol=0.0, atol=_ANGLE)


def _parts(result: Any) -> Iterator[tuple[str, Any]]:
    """Paths and components, with the orders of each."""
    for name, component in result.components.items():
        yield name, component
        yield from ((f"{name}/{order}", part) for order, part in component.orders.items())


def _are_asked_for(result: Any, asked: Any) -> bool:
    """Whether the rays are those of the scene; replicates of equal size may need some more, and runs add up."""
    exact = result.estimator in ("analog", INTEGRATED) and not JOINED & result.provenance.keys()
    if exact and (result.rays > asked.most_rays).any():
        return False
    return result.status == "partial" or asked.target is not None or bool((result.rays >= asked.rays).all())


def _are_batches(part: Any) -> bool:
    if part.batches.shape[1] < 2:
        return False
    own = np.array([name not in ("analog", INTEGRATED) for name in part.estimator])
    blocks = np.where(own[:, None, None, None], block_sums(part.energy), 0.0)
    return np.allclose(part.batches.mean(axis=1), blocks, rtol=_SUM, atol=_SUM)


def _is_audited(component: Any, audited: np.ndarray) -> bool:
    # Other estimators are audited by a run of independent paths beside theirs.
    same = [name in ("analog", INTEGRATED) for name in component.estimator]
    return np.allclose(component.energy[same].sum(axis=(2, 3)), audited[same], rtol=_SUM, atol=_SUM)


def _audited(result: Any, component: str) -> np.ndarray:
    """Energy of a component as the audit says, shape (M, C)."""
    audit = result.audit
    sampled = {"reflection/internal": "reflected_internal", "transmission": "transmitted"}
    return audit.energy[sampled[component]] if component in sampled else audit.direct_integrated


def _is_averaged(part: Any, cells: Any) -> bool:
    # One direction after the other: slices may be large.
    for number, valid in enumerate(cells.valid):
        size = np.where(valid, cells.projected_solid_angle[number], 0.0)
        for bsdf, energy in ((part.bsdf, part.energy), (part.bsdf_stderr, part.stderr)):
            there = np.where(size > 0.0, energy[number], 0.0)
            if not np.allclose(bsdf[number] * size, there, rtol=_SUM, atol=_TINY) or bsdf[number][:, size == 0.0].any():
                return False
    return True


def _is_balanced(result: Any) -> bool:
    return bool((np.abs(result.audit.residual[result.rays > 0]) <= _SUM).all())
