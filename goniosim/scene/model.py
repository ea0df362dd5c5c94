"""The scene: what a user describes, typed and checked."""

import hashlib
import io
import json
import re
from collections.abc import Iterable
from typing import Annotated, Any, Literal, Self

from pydantic import ConfigDict, Field, field_validator, model_validator
from ruamel.yaml import YAML

from goniosim.scene.layers import ABSENT, Interface, Layer, Part
from goniosim.scene.quantity import Checked, Number, check_each, count, mistake, mistakes
from goniosim.scene.structure import structure_mistakes
from goniosim.scene.target import Target, TimeSpan

MAX_CELLS = 4_000_000
MAX_DIRECTIONS = 1000
# Of the simulation: how much to trace and with what. The same numbers come out, or more of them.
NOT_IDENTITY = ("rays", "target", "max_rays", "max_time", "threads")
# Of the simulation: what has a meaning beside a target only.
LIMITS = ("max_rays", "max_time")

Theta = Number(0.0, 90.0, "be 0 or more and below 90: it is the angle from the normal in degrees", open_high=True)
CellCount = Number(1, MAX_CELLS, "be a whole number from 1 to 4e6", integer=True)
DEFAULT_RAYS = 10_000_000
MOST_RAYS = 10**15
Rays = Number(100, MOST_RAYS, "be a whole number from 100 to 1e15, such as 1e7", integer=True)
Seed = Number(0, 2**63 - 1, "be a whole number from 0 to 2^63 - 1", integer=True)
Orders = Number(1, 16, "be a whole number from 1 to 16; leave it out for no decomposition", integer=True)
Threads = Number(1, 4096, "be a whole number from 1 to 4096; leave it out to use every core", integer=True)

# More layers or angles are counted by a short text, not listed.
MOST_SHOWN = 10


class FileName(Checked):
    """Annotation for a pydantic field: text that is safe as the stem of a file name."""

    pattern = r"[A-Za-z0-9_+=-][A-Za-z0-9._+=-]{0,119}"
    rule = "must be usable as a file name: 1 to 120 letters, digits or any of . _ + = - with no dot in front"

    def check(self, value: object) -> str:
        """Return the name, or raise the mistake in it."""
        if not isinstance(value, str):
            raise mistake(f"{self.rule}; write it between quotes if it looks like a number")
        if not re.fullmatch(self.pattern, value):
            raise mistake(self.rule)
        return value

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema of such a name."""
        return {"type": "string", "pattern": f"^{self.pattern}$"}


class Angles(Checked):
    """Annotation for a pydantic field: the distinct angles of incidence."""

    def check(self, value: object) -> tuple[float, ...]:
        """Return a tuple of angles in degrees, or raise the mistakes in it."""
        if not isinstance(value, (list, tuple)):
            example = f": write [{value}]" if Theta.accepts(value) else ", such as [0, 30, 60]"
            raise mistake(f"must be a list of angles in degrees{example}")
        if not value:
            raise mistake("must hold at least one angle, such as [45]")
        if len(value) > MAX_DIRECTIONS:
            raise mistake(f"must hold no more than {MAX_DIRECTIONS} angles: split it over several files")
        angles = check_each(Theta, value)
        again = [index for index, angle in enumerate(angles) if angle in angles[:index]]
        if again:
            message = "must differ from the angles before it: remove it"
            raise mistakes([((index,), message, value[index]) for index in again])
        return angles

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema of the list of angles."""
        return {
            "type": "array",
            "items": Theta.json_schema(),
            "minItems": 1,
            "maxItems": MAX_DIRECTIONS,
            "uniqueItems": True,
        }


class Material(Part):
    """A stack of plane-parallel layers, with air above."""

    name: Annotated[str, FileName()] = Field(description="Name of the material and of its result file.")
    layers: tuple[Layer, ...] = Field(
        description="Top to bottom, beginning at the top interface; air lies above.",
        json_schema_extra={"minItems": 1},
    )

    @field_validator("layers", mode="after")
    @classmethod
    def _ordered(cls, layers: tuple[Layer, ...]) -> tuple[Layer, ...]:
        kinds = ["medium" if layer.interface is None else layer.interface.type for layer in layers]
        found = structure_mistakes(kinds)
        if found:
            raise mistakes([(location, message, None) for location, message in found])
        return layers

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The interfaces from top to bottom, tuple of K interface models."""
        return tuple(layer.interface for layer in self.layers if layer.interface is not None)

    @property
    def tau(self) -> tuple[tuple[float, ...], ...]:
        """Optical depth between each interface and the next, per channel.

        Returns
        -------
        tuple of K - 1 tuples of 3 floats
            Media in a row add up; zeros where two interfaces touch.
        """
        gaps: list[tuple[float, ...]] = []
        for layer in self.layers:
            if layer.medium is None:
                gaps.append((0.0, 0.0, 0.0))
            else:
                gaps[-1] = tuple(sum(pair) for pair in zip(gaps[-1], layer.medium.tau_rgb, strict=True))
        return tuple(gaps[:-1])

    @property
    def transmits(self) -> bool:
        """Whether light can leave below: the last interface is a dielectric."""
        return not self.interfaces[-1].opaque


class Incident(Part):
    """Where the light comes from."""

    theta_deg: Annotated[tuple[float, ...], Angles()] = Field(
        description="Angles of incidence from the normal, in degrees; the light stands at phi = 0."
    )


class Slice(Part):
    """The cells into which the light that leaves is sorted."""

    parametrization: Literal["classic", "half"] = Field(
        default="classic",
        description="classic: theta_v and phi_v; half: sqrt(theta_h pi/2) and phi_h, for sharp lobes.",
    )
    rows: Annotated[int, CellCount] = Field(default=90, description="Rows of cells over the elevation.")
    columns: Annotated[int, CellCount] = Field(default=360, description="Columns of cells over the azimuth.")

    @model_validator(mode="after")
    def _bounded(self) -> Self:
        if self.rows * self.columns > MAX_CELLS:
            raise mistake(
                f"must have no more than 4e6 cells, and rows x columns is {self.rows * self.columns}: "
                "use fewer of either"
            )
        return self


class Simulation(Part):
    """How much to trace, and how."""

    model_config = ConfigDict(
        json_schema_extra={
            "not": {"required": ["rays", "target"]},
            "dependentRequired": {name: ["target"] for name in LIMITS},
        }
    )

    rays: Annotated[int | None, Rays] = Field(
        default=None,
        description="Rays per incident direction, where there is no target.",
        json_schema_extra={"default": DEFAULT_RAYS},
    )
    target: Target = Field(default=ABSENT, description="Stop at an accuracy; it takes the place of rays.")
    max_rays: Annotated[int | None, Rays] = Field(
        default=None, description="Rays per incident direction at most, where there is a target."
    )
    max_time: Annotated[float | None, TimeSpan()] = Field(
        default=None, description="Time at most, where there is a target: seconds, or 90s, 10m, 2h or 1h30m."
    )
    seed: Annotated[int, Seed] = Field(default=1, description="Seed of the random numbers.")
    estimator: Literal["auto", "analog", "split", "operator", "connection"] = Field(
        default="auto",
        description="Which Monte Carlo estimator to use. auto: what promises most for the scene; analog: independent "
        "paths, the reference.",
    )
    orders: Annotated[int | None, Orders] = Field(
        default=None, description="Decompose by this many orders (events on the top interface)."
    )
    threads: Annotated[int | None, Threads] = Field(
        default=None, description="Threads to use; without it, one for each core."
    )

    @model_validator(mode="before")
    @classmethod
    def _measured(cls, content: object) -> object:
        if isinstance(content, dict) and not {"rays", "target"} & content.keys():
            return {**content, "rays": DEFAULT_RAYS}
        return content

    @model_validator(mode="after")
    def _one_measure(self) -> Self:
        found: list[tuple[tuple[int | str, ...], str, object]] = []
        if self.target is None:
            message = "limits a target, and there is none: add target: {relative_error: 1%}, or remove it"
            limits = {name: getattr(self, name) for name in LIMITS}
            found += [((name,), message, value) for name, value in limits.items() if value is not None]
        elif self.rays is not None:
            message = "must not stand beside target, which decides how many are traced: remove one of them"
            found.append((("rays",), message, self.rays))
        if found:
            raise mistakes(found)
        return self

    @property
    def asked(self) -> str:
        """What ends the simulation, in words: ``1e7 rays``, or ``target 1 % of slice``."""
        return f"{count(self.rays)} rays" if self.rays is not None else f"target {self.target}"

    @property
    def most_rays(self) -> int:
        """Rays per incident direction that are traced at most, whatever a target takes."""
        return self.rays or self.max_rays or MOST_RAYS


class Scene(Part):
    """One material and its measurement, complete."""

    material: Material
    incident: Incident
    slice: Slice = Slice()
    simulation: Simulation = Simulation()

    def __repr__(self) -> str:
        layers = [layer.interface.type if layer.interface else "medium" for layer in self.material.layers]
        angles = [f"{theta:.10g}" for theta in self.incident.theta_deg]
        parts = [
            ", ".join(layers) if len(layers) <= MOST_SHOWN else f"{len(layers)} layers",
            f"theta_deg {', '.join(angles)}" if len(angles) <= MOST_SHOWN else f"{len(angles)} directions",
            f"{self.slice.parametrization} slices of {self.slice.rows} x {self.slice.columns} cells",
            self.simulation.asked,
            f"seed {self.simulation.seed}",
        ]
        return f"<Scene {self.material.name}: {'; '.join(parts)}>"

    __str__ = __repr__

    @property
    def total_rays(self) -> int | None:
        """Rays of all incident directions together; None where a target decides how many that will be."""
        return None if self.simulation.rays is None else len(self.incident.theta_deg) * self.simulation.rays

    def to_yaml(self) -> str:
        """Write the scene as YAML, complete with its defaults.

        Returns
        -------
        str
            Text that loads back to an equal scene.
        """
        yaml = YAML(typ="safe", pure=True)
        yaml.default_flow_style = None
        yaml.representer.sort_base_mapping_type_on_output = False
        yaml.width = 100
        stream = io.StringIO()
        yaml.dump(self.model_dump(mode="json", exclude_none=True), stream)
        return stream.getvalue()

    def config_hash(self) -> str:
        """Identity of the scene: results of the same identity differ in nothing but their noise.

        The seed and the estimator belong to it. The name of the material, the
        number of rays or the target with its limits, and the number of threads
        do not, and neither does the way of writing: a scalar for three equal
        channels, or media in a row for their sum.

        Returns
        -------
        str
            SHA-256 of the canonical JSON, 64 hexadecimal digits.
        """
        content = {
            "interfaces": [_expanded(interface) for interface in self.material.interfaces],
            "tau": self.material.tau,
            "incident": self.incident.model_dump(),
            "slice": self.slice.model_dump(),
            "simulation": self.simulation.model_dump(exclude=set(NOT_IDENTITY)),
        }
        text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()


def total_rays(scenes: Iterable[Scene]) -> int | None:
    """Rays of several scenes together; None if a target decides in any of them."""
    each = [scene.total_rays for scene in scenes]
    return None if None in each else sum(filter(None, each))


def _expanded(interface: Interface) -> dict[str, Any]:
    rgb_of = {name: getattr(interface, f"{name}_rgb", None) for name in type(interface).model_fields}
    return {name: rgb_of[name] or value for name, value in interface.model_dump().items()}
