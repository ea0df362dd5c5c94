"""`goniosim models`: the published models that can be compared."""

import click

from .policy import debug_option


@click.command()
@debug_option
def models():
    """List the models: what they apply to, options, nanoseconds per evaluation, citation."""
    from goniosim.report.models import description

    click.echo(description())
