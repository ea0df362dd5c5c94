"""The command `goniosim`. Only click and the standard library are imported here, so that help is instant."""

import click

from .check import check
from .compare import compare
from .info import info
from .models import models
from .plot import plot
from .policy import PolicyGroup, debug_option
from .schema import schema
from .simulate import simulate
from .versions import versions


def _show_version(ctx, param, value):
    if value:
        import goniosim

        click.echo(f"goniosim {goniosim.__version__}")
        ctx.exit()


@click.group(cls=PolicyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--version",
    is_flag=True,
    expose_value=False,
    is_eager=True,
    callback=_show_version,
    help="Show the version and exit.",
)
@debug_option
def main():
    """A virtual goniometer: BRDF and BTDF slices of layered materials by Monte Carlo."""


for command in (simulate, check, info, plot, compare, models, schema, versions):
    main.add_command(command)
