"""Options that several commands share."""

from decimal import Decimal, InvalidOperation

import click

# 2^64 has as many. What a number may be is said where its meaning is known.
MOST_DIGITS = 20
SHOWN = 40


class Count(click.ParamType):
    """A whole number that may be written as ``1e7``."""

    name = "number"

    def convert(self, value, param, ctx):
        """Return the number as an int."""
        if isinstance(value, int):
            return value
        try:
            number = Decimal(value)
        except InvalidOperation:
            number = None
        if number is None or not number.is_finite() or number < 0:
            self._fail(value, "is not a whole number such as 10000000 or 1e7", param, ctx)
        # Looked at before it is written out with all its digits, of which there may be a billion.
        if number.adjusted() >= MOST_DIGITS:
            self._fail(value, f"is too large: {MOST_DIGITS} digits are the most", param, ctx)
        if number.adjusted() < -MOST_DIGITS and number or number != int(number):
            self._fail(value, "is not a whole number such as 10000000 or 1e7", param, ctx)
        return int(number)

    def _fail(self, value, message, param, ctx):
        shown = value if len(value) <= SHOWN else f"{value[:SHOWN]}..."
        self.fail(f"{shown!r} {message}", param, ctx)


set_option = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="PATH=VALUE",
    help="Change one value of the scene, as in --set simulation.orders=3; may be repeated.",
)
