"""Options that several commands share."""

from decimal import Decimal, InvalidOperation

import click
from click.shell_completion import CompletionItem


def refuse_commas(kind, value, param, ctx, whole=False):
    """Fail with the number that was meant, if a value has commas in it."""
    if "," in value:
        from goniosim.scene.quantity import without_commas

        if meant := without_commas(value, whole):
            kind.fail(f"{value!r} has a comma: write {meant}", param, ctx)


class Real(click.ParamType):
    """A number, with a point before its decimals."""

    name = "number"

    def convert(self, value, param, ctx):
        """Return the number as a float."""
        if isinstance(value, float):
            return value
        refuse_commas(self, value, param, ctx)
        try:
            return float(value)
        except ValueError:
            self.fail(f"{value!r} is not a number such as 22.5", param, ctx)


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
        refuse_commas(self, value, param, ctx, whole=True)
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


class FileName(click.ParamType):
    """A path, taken as it is: what is wrong with it, the one who opens it says. Shells complete it."""

    name = "path"

    def shell_complete(self, ctx, param, incomplete):
        """Leave the completion of file names to the shell."""
        return [CompletionItem(incomplete, type="file")]


PATH = FileName()


def _overrides(ctx, param, values):
    from goniosim.scene import Override

    return [Override(value, f"--set {value}") for value in values]


class Quantity(click.ParamType):
    """A number that may have a unit, as the scene knows it: ``1%``, ``10m``."""

    def __init__(self, name, kind):
        self.name = name
        self._kind = kind

    def convert(self, value, param, ctx):
        """Return the text, if it is one that the scene takes."""
        from goniosim.scene import target

        if flaw := getattr(target, self._kind)().flaw(value):
            self.fail(f"{value!r} {flaw}", param, ctx)
        return value


def seconds_of(time):
    """Seconds of a `Quantity` that is a time; None for None."""
    from goniosim.scene import target

    return None if time is None else target.TimeSpan().check(time)


# As in goniosim/scene, which is not loaded for help.
ESTIMATORS = ("auto", "analog", "split", "operator", "connection")
OF = ("slice", "albedo", "cells")

# What options of the same name stand for, where that is no value right under `simulation`.
PATHS = {"target": "target.relative_error", "of": "target.of"}


def simulation_options(command):
    """Add the options that stand for values under ``simulation``, for `overrides_of`."""
    return with_options(command, SIMULATION_OPTIONS)


def with_options(command, options):
    """Add options to a command, in this order."""
    for option in reversed(options):
        command = option(command)
    return command


def overrides_of(given):
    """Changes of the scene for options that stand for values under ``simulation``; None is no change."""
    from goniosim.scene import Override

    asked = {name: value for name, value in given.items() if value is not None}
    if {"rays", "target"} <= asked.keys():
        raise click.UsageError("--target decides how many rays are traced: give it or --rays")
    return [
        Override(f"simulation.{PATHS.get(name, name)}={value}", f"--{name.replace('_', '-')} {value}")
        for name, value in asked.items()
    ]


# What is to be traced, whatever it is traced on.
MEASURE_OPTIONS = (
    click.option("--rays", type=Count(), metavar="N", help="Rays per incident direction, such as 1e7."),
    click.option(
        "--target",
        type=Quantity("share", "Share"),
        metavar="ERROR",
        help="Instead of rays, stop at a relative error: 1% or 0.01, in each direction and component.",
    ),
    click.option(
        "--of",
        type=click.Choice(OF),
        help="What it is the error of [default: slice, its noise over its norm].",
    ),
    click.option("--max-rays", type=Count(), metavar="N", help="Rays per direction at most, with a target."),
    click.option(
        "--max-time",
        type=Quantity("time", "TimeSpan"),
        metavar="TIME",
        help="Time per material at most, with a target: seconds, or 90s, 10m, 2h or 1h30m.",
    ),
    click.option("--estimator", type=click.Choice(ESTIMATORS), help="How to estimate [default: auto]."),
)
SIMULATION_OPTIONS = (
    *MEASURE_OPTIONS,
    click.option("--threads", type=click.IntRange(min=1), metavar="T", help="Threads; all cores by default."),
)
set_option = click.option(
    "--set",
    "overrides",
    multiple=True,
    callback=_overrides,
    metavar="PATH=VALUE",
    help="Change one value of the scene, as in --set simulation.orders=3; may be repeated.",
)


def complete_models(ctx, param, incomplete):
    """Names of models for the tab key; the last of those with commas between."""
    from goniosim.models import MODELS

    chosen, comma, word = incomplete.rpartition(",")
    return [f"{chosen}{comma}{name}" for name in MODELS if name.startswith(word)]
