"""`goniosim models`: the published models that can be compared."""

import click

from .policy import debug_option


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print everything as JSON, for programs.")
@debug_option
def models(as_json):
    """List the published models that can be compared.

    For each: citation, what it applies to, nanoseconds per evaluation measured here, options with
    their defaults.

    \b
    Example: goniosim models --json
    """  # noqa: D301
    import json

    from goniosim.report.models import as_data, description

    click.echo(json.dumps(as_data(), indent=1) if as_json else description())
