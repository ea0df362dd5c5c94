"""An accuracy in the place of a number of rays: which error of what, and how it and its limits are written."""

import re
from dataclasses import dataclass
from decimal import Decimal
from typing import Annotated, Any, Literal

from pydantic import Field

from goniosim.scene.layers import Part
from goniosim.scene.quantity import Checked, Number, looks_numeric, mistake, without_commas

_PERCENT = re.compile(r"(.*?) *%", re.DOTALL)
_SPAN = re.compile(r"(?:(\d+(?:\.\d+)?)h)?(?:(\d+(?:\.\d+)?)m)?(?:(\d+(?:\.\d+)?)s)?")
_UNITS = (3600, 60, 1)


@dataclass(frozen=True)
class Share(Checked):
    """Annotation for a pydantic field: a part of a whole, as ``1%`` or ``0.01``."""

    number: Number = Number(0.0, 1.0, "lie above 0 and below 1: one percent is 1% or 0.01", open_high=True)

    def check(self, value: object) -> float:
        """Return the share as a float, or raise the mistake in it."""
        if isinstance(value, str) and (written := _PERCENT.fullmatch(value.strip())):
            if meant := without_commas(written[1]):
                raise mistake(f"must be a number without a comma: write {meant}%")
            if looks_numeric(written[1]):
                # In decimals, so that 0.7% is 0.007.
                value = float(Decimal(written[1]) / 100)
        share = self.number.check(value)
        if share == 0.0:
            raise mistake(f"must {self.number.rule}")
        return share

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema of such a share."""
        percent = {"type": "string", "pattern": r"^[0-9.]+(e-?[0-9]+)? *%$"}
        return {"anyOf": [{"type": "number", "exclusiveMinimum": 0.0, "exclusiveMaximum": 1.0}, percent]}


@dataclass(frozen=True)
class TimeSpan(Checked):
    """Annotation for a pydantic field: seconds, or hours, minutes and seconds as ``1h30m``."""

    number: Number = Number(0.0, 1e9, "be a time above 0: seconds, or 90s, 10m, 2h or 1h30m")

    def check(self, value: object) -> float:
        """Return the time in seconds as a float, or raise the mistake in it."""
        if isinstance(value, str) and not looks_numeric(value):
            written = _SPAN.fullmatch(value.strip())
            if not value.strip() or written is None:
                raise mistake(f"must {self.number.rule}")
            value = float(sum(Decimal(part or 0) * unit for part, unit in zip(written.groups(), _UNITS, strict=True)))
        seconds = self.number.check(value)
        if seconds == 0.0:
            raise mistake(f"must {self.number.rule}")
        return seconds

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema of such a time."""
        part = r"([0-9]+(\.[0-9]+)?{})?"
        text = {"type": "string", "pattern": f"^{''.join(part.format(unit) for unit in 'hms')}$", "minLength": 2}
        return {"anyOf": [{"type": "number", "exclusiveMinimum": 0.0, "maximum": self.number.high}, text]}


class Target(Part):
    """The error at which a simulation stops, in every incident direction and component."""

    relative_error: Annotated[float, Share()] = Field(
        description="Stop once the standard error is this share of what it is the error of: 1% or 0.01."
    )
    of: Literal["slice", "albedo", "cells"] = Field(
        default="slice",
        description="slice: noise of a slice over its norm; albedo: its energy; cells: 95 % of the cells that hold "
        "95 % of its energy.",
    )

    def __str__(self) -> str:
        return f"{100.0 * self.relative_error:.6g} % of {self.of}"

    def is_met_by(self, other: "Target") -> bool:
        """Whether what reaches another target reaches this one as well."""
        return self.of == other.of and other.relative_error <= self.relative_error
