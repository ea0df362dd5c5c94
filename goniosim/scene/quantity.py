"""Numbers a user may write: each quantity is one range and one sentence that explains it."""

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any

from pydantic import ValidationError
from pydantic_core import InitErrorDetails, PydanticCustomError, core_schema

CHANNELS = ("R", "G", "B")
EXACT_INTEGERS = 2**53
# How the mistake of a value begins that is no number at all; its rule follows.
NO_NUMBER = "must be a number, and "

Triple = tuple[float, float, float]


def mistake(message: str) -> PydanticCustomError:
    """One mistake of the user, for pydantic; braces in the message stay as they are.

    Parameters
    ----------
    message : str
        One clear sentence with its remedy.

    Returns
    -------
    pydantic_core.PydanticCustomError
    """
    return PydanticCustomError("scene", "{message}", {"message": message})


def mistakes(located: Iterable[tuple[tuple[int | str, ...], str, object]]) -> ValidationError:
    """Several mistakes at once, each at its own place below the value that is being validated.

    Parameters
    ----------
    located : list of (tuple, str, object)
        Location relative to the value, message, and the offending input.

    Returns
    -------
    pydantic.ValidationError
    """
    details = [
        InitErrorDetails(type=mistake(message), loc=location, input=value) for location, message, value in located
    ]
    return ValidationError.from_exception_data("scene", details)


class Checked(ABC):
    """Base of annotations for pydantic fields that check a value by themselves."""

    @abstractmethod
    def check(self, value: object) -> object:
        """Return the value as it is kept, or raise the mistakes in it."""

    @abstractmethod
    def json_schema(self) -> dict[str, Any]:
        """JSON Schema of such a value."""

    def accepts(self, value: object) -> bool:
        """Whether there is no mistake in a value."""
        try:
            self.check(value)
        except (PydanticCustomError, ValidationError):
            return False
        return True

    def flaw(self, text: str) -> str | None:
        """What is wrong with a value as a scene file would write it, or None."""
        try:
            self.check(float(text) if looks_numeric(text) else text)
        except PydanticCustomError as error:
            return error.message()
        return None

    def __get_pydantic_core_schema__(self, source: object, handler: object) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)

    def __get_pydantic_json_schema__(self, schema: object, handler: object) -> dict[str, Any]:
        return self.json_schema()


@dataclass(frozen=True)
class Number(Checked):
    """Annotation for a pydantic field: a finite number in a range.

    Parameters
    ----------
    low, high : float
        Range, both ends included unless `open_high`.
    rule : str
        What the number must be, as the end of a sentence ("must ...").
    integer : bool
        Only whole numbers; 1e7 is one.
    open_high : bool
        The upper end is excluded.
    zero_below : bool
        Zero is allowed although it lies below `low`.
    """

    low: float
    high: float
    rule: str
    integer: bool = False
    open_high: bool = False
    zero_below: bool = False

    def check(self, value: object) -> float:
        """Return the number as int or float, or raise the mistake in it."""
        if isinstance(value, str) and looks_numeric(value):
            raise mistake("must be a number, and it is text here: write it without quotes")
        if isinstance(value, str) and (meant := without_commas(value, self.integer)):
            raise mistake(f"must be a number without a comma: write {meant}")
        if isinstance(value, bool) or not isinstance(value, Real):
            raise mistake(f"must {self.rule}" if self.integer else f"{NO_NUMBER}{self.rule}")
        number = int(value) if isinstance(value, Integral) else float(value)
        if isinstance(number, float) and not math.isfinite(number):
            raise mistake(f"must be finite, and {self.rule}")
        above = number >= self.high if self.open_high else number > self.high
        if above or (number < self.low and not (self.zero_below and number == 0)):
            raise mistake(f"must {self.rule}")
        # Adding zero turns -0.0 into 0.0: one value, one hash.
        return self._whole(number) if self.integer else float(number) + 0.0

    def _whole(self, number: float) -> int:
        if isinstance(number, int):
            return number
        if number != math.floor(number):
            raise mistake(f"must {self.rule}")
        if number > EXACT_INTEGERS:
            raise mistake("must be written with all its digits: a number this large is not exact with an exponent")
        return int(number)

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema of one such number."""
        upper = "exclusiveMaximum" if self.open_high else "maximum"
        ranged: dict[str, Any] = {"minimum": self.low, upper: self.high}
        if self.zero_below:
            ranged = {"anyOf": [{"const": 0}, ranged]}
        return {"type": "integer" if self.integer else "number", **ranged}


@dataclass(frozen=True)
class PerChannel(Checked):
    """Annotation for a pydantic field: one number for all channels, or one for each of R, G, B.

    Parameters
    ----------
    number : Number
        What each of the numbers must be.
    """

    number: Number

    def check(self, value: object) -> float | tuple[float, ...]:
        """Return a float, or a tuple of three floats, or raise the mistakes in it."""
        if not isinstance(value, (list, tuple)):
            return self.number.check(value)
        if len(value) != len(CHANNELS):
            decimals = "; a comma ends a number, so write 0.5 and not 0,5" if len(value) == 2 * len(CHANNELS) else ""
            raise mistake(
                "must be one number for all channels or a list of three, for R, G and B: "
                f"this list has {len(value)}{decimals}"
            )
        return check_each(self.number, value)

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema of one number or a list of three."""
        one = self.number.json_schema()
        return {"anyOf": [one, {"type": "array", "items": one, "minItems": 3, "maxItems": 3}]}


def check_each(number: Number, values: Sequence[object]) -> tuple[float, ...]:
    """Check a list of numbers, all of them even when one is wrong.

    Parameters
    ----------
    number : Number
    values : list or tuple

    Returns
    -------
    tuple of float or int

    Raises
    ------
    pydantic.ValidationError
        With one mistake for each wrong item, located at its index.
    """
    found: list[float] = []
    located: list[tuple[tuple[int | str, ...], str, object]] = []
    for index, item in enumerate(values):
        try:
            found.append(number.check(item))
        except PydanticCustomError as error:
            located.append(((index,), error.message(), item))
    if located:
        raise mistakes(located)
    return tuple(found)


def rgb(value: float | Triple) -> Triple:
    """Expand a scalar that stands for all channels.

    Parameters
    ----------
    value : float or tuple of 3 floats

    Returns
    -------
    tuple of 3 floats
    """
    return value if isinstance(value, tuple) else (value, value, value)


def without_commas(text: str, whole: bool = False) -> str | None:
    """The number that was meant by a text with commas in it, or None.

    Parameters
    ----------
    text : str
    whole : bool
        Of a whole number, commas before three digits each separate thousands; else one marks decimals.
    """
    text = text.strip()
    if whole and re.fullmatch(r"[+-]?\d{1,3}(,\d{3})+", text):
        return text.replace(",", "")
    if text.count(",") == 1 and looks_numeric(text.replace(",", ".")):
        return text.replace(",", ".")
    return None


def looks_numeric(text: str) -> bool:
    """Whether a text is a number as Python writes it."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def count(number: float) -> str:
    """Format a number of rays: ``16000000`` as ``1.6e7``, ``1234567`` as ``1.235e6``."""
    number = float(number)
    if number < 1e4:
        return f"{number:.0f}"
    mantissa, exponent = f"{number:.3e}".split("e")
    mantissa = mantissa.rstrip("0").rstrip(".")
    return f"{mantissa}e{int(exponent)}"


def percent(share: float, digits: int = 2) -> str:
    """Format a share as a percentage: ``0.03 %``, ``99.9 %``, ``100 %``, ``250 %``.

    Parameters
    ----------
    share : float
    digits : int
        More where these would take an exponent, up to a million.
    """
    value = 100.0 * share
    shown = f"{value:.{digits}g}"
    if "e+" in shown and value < 1e6:
        shown = f"{value:.3g}" if value < 999.5 else f"{value:.0f}"
    return f"{shown} %"
