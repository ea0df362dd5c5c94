"""The command `goniosim`. Only click and the standard library are imported here, so that help is instant."""

import click

from .check import check
from .compare import compare
from .cost import cost
from .hard import hard
from .info import info
from .init import init
from .merge import merge
from .models import models
from .plan import plan
from .plot import plot
from .policy import PolicyGroup, debug_option
from .schema import schema
from .simulate import simulate
from .status import status
from .submit import submit
from .versions import versions
from .warmup import warmup


def _show_version(ctx, param, value):
    if value:
        import goniosim

        click.echo(f"goniosim {goniosim.__version__}")
        ctx.exit()


# As in goniosim/errors.py.
EPILOG = """\b
To begin:
  goniosim init && goniosim simulate quickstart.yaml
  goniosim plot metallic-patina.h5

\b
Exit codes:
  0    success
  1    a bug in goniosim; --debug shows where; or a hard case failed
  2    the command line is wrong
  3    the scene file or an override is wrong
  4    the output cannot be written or would replace something, or memory is short
  5    the file is not of goniosim
  6    the file is damaged
  7    the file is of a newer goniosim
  8    the result cannot be used for what was asked
  9    a target was not reached within its limits; the result is in the output file
  10   the operating system or an environment variable stands in the way
  75   simulate was stopped by a signal or its time limit: run it again, it goes on
  129  another command was stopped: the terminal was closed (SIGHUP)
  130  stopped by Ctrl-C; what was gathered is in the output file
  143  another command was stopped by SIGTERM
"""


@click.group(cls=PolicyGroup, epilog=EPILOG, context_settings={"help_option_names": ["-h", "--help"]})
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


COMMANDS = (
    *(init, simulate, check, cost, info, plot, compare, models),
    *(plan, submit, status, merge, warmup),
    *(hard, schema, versions),
)
for command in COMMANDS:
    main.add_command(command)
