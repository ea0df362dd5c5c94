"""`goniosim versions`: what a bug report needs."""

import click

from .policy import debug_option


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print everything as JSON, for programs.")
@debug_option
def versions(as_json):
    """Show what a bug report needs: versions, machine, compiler."""
    import json

    from goniosim.report import versions

    click.echo(json.dumps(versions.as_data(), indent=1) if as_json else versions.description())
