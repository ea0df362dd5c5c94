"""Options that several commands share."""

from decimal import Decimal, InvalidOperation

import click


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
        if number is None or not number.is_finite() or number != int(number) or number < 0:
            self.fail(f"{value!r} is not a whole number such as 10000000 or 1e7", param, ctx)
        return int(number)


def _overrides(ctx, param, values):
    from goniosim.scene import Override

    return [Override(value, f"--set {value}") for value in values]


set_option = click.option(
    "--set",
    "overrides",
    multiple=True,
    callback=_overrides,
    metavar="PATH=VALUE",
    help="Change one value of the scene, as in --set simulation.orders=3; may be repeated.",
)
