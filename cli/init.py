"""`goniosim init`: a scene file to begin with."""

import os
import shlex

import click

from .options import PATH
from .policy import debug_option

# The files of goniosim/scene/examples.
NAMES = ("quickstart", "plastic", "metal", "slab", "study")


@click.command()
@click.argument("name", type=click.Choice(NAMES), default="quickstart", metavar="[NAME]")
@click.option(
    "-o", "--output", type=PATH, metavar="FILE", help="File to write; - prints it [default: NAME.yaml, here]."
)
@debug_option
def init(name, output):
    """Write a commented example of a scene file.

    \b
    NAME is one of
      quickstart   a coloured metal under a rough, tinted coat (the default)
      plastic      a glossy coat over a diffuse colour
      metal        gold under a smooth lacquer
      slab         frosted glass, which transmits
      study        several materials from one file

    A file that is there already is never overwritten.

    \b
    Example: goniosim init plastic
    """  # noqa: D301
    from goniosim.errors import OutputError
    from goniosim.scene import example
    from goniosim.writing import make_folder, write_text

    if output == "-":
        click.echo(example(name), nl=False)
        return
    # Not mistaken for an option by the command that is named below.
    path = f"./{output}" if output and output.startswith("-") else output or f"{name}.yaml"
    if os.path.lexists(path):
        raise OutputError(f"{path}: exists, and is not overwritten; choose another name with -o, or remove it")
    make_folder(os.path.dirname(path) or ".")
    write_text(path, example(name))
    click.echo(f"{path} is written. Next:\n\n  goniosim simulate {shlex.quote(path)}")
