"""Numbers a user may write: each quantity is one range and one sentence that explains it."""

import math
from dataclasses import dataclass
from numbers import Integral, Real

from pydantic import ValidationError
from pydantic_core import InitErrorDetails, PydanticCustomError, core_schema

CHANNELS = ("R", "G", "B")
EXACT_INTEGERS = 2**53


def mistake(message):
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


def mistakes(located):
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


class Checked:
    """Base of annotations for pydantic fields that have the methods `check` and `json_schema`."""

    def __get_pydantic_core_schema__(self, source, handler):
        return core_schema.no_info_plain_validator_function(self.check)

    def __get_pydantic_json_schema__(self, schema, handler):
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

    def check(self, value):
        """Return the number as int or float, or raise the mistake in it."""
        if isinstance(value, str) and _looks_numeric(value):
            raise mistake("must be a number, and it is text here: write it without quotes")
        if isinstance(value, bool) or not isinstance(value, Real):
            raise mistake(f"must {self.rule}" if self.integer else f"must be a number, and {self.rule}")
        if not isinstance(value, Integral) and not math.isfinite(value):
            raise mistake(f"must be finite, and {self.rule}")
        above = value >= self.high if self.open_high else value > self.high
        if above or (value < self.low and not (self.zero_below and value == 0)):
            raise mistake(f"must {self.rule}")
        # Adding zero turns -0.0 into 0.0: one value, one hash.
        return self._whole(value) if self.integer else float(value) + 0.0

    def _whole(self, value):
        if isinstance(value, Integral):
            return int(value)
        if value != math.floor(value):
            raise mistake(f"must {self.rule}")
        if value > EXACT_INTEGERS:
            raise mistake("must be written with all its digits: a number this large is not exact with an exponent")
        return int(value)

    def json_schema(self):
        """JSON Schema of one such number."""
        upper = "exclusiveMaximum" if self.open_high else "maximum"
        ranged = {"minimum": self.low, upper: self.high}
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

    def check(self, value):
        """Return a float, or a tuple of three floats, or raise the mistakes in it."""
        if not isinstance(value, (list, tuple)):
            return self.number.check(value)
        if len(value) != len(CHANNELS):
            raise mistake(
                f"must be one number for all channels or a list of three, for R, G and B: this list has {len(value)}"
            )
        return check_each(self.number, value)

    def json_schema(self):
        """JSON Schema of one number or a list of three."""
        one = self.number.json_schema()
        return {"anyOf": [one, {"type": "array", "items": one, "minItems": 3, "maxItems": 3}]}


def check_each(number, values):
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
    found, located = [], []
    for index, item in enumerate(values):
        try:
            found.append(number.check(item))
        except PydanticCustomError as error:
            located.append(((index,), error.message(), item))
    if located:
        raise mistakes(located)
    return tuple(found)


def rgb(value):
    """Expand a scalar that stands for all channels.

    Parameters
    ----------
    value : float or tuple of 3 floats

    Returns
    -------
    tuple of 3 floats
    """
    return value if isinstance(value, tuple) else (value,) * len(CHANNELS)


def _looks_numeric(text):
    try:
        float(text)
    except ValueError:
        return False
    return True
