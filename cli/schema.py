"""`goniosim schema`: the format of scene files for editors."""

import click

from .policy import debug_option


@click.command()
@debug_option
def schema():
    """Print the JSON Schema of scene files."""
    import json

    from goniosim.scene import json_schema

    click.echo(json.dumps(json_schema(), indent=2, ensure_ascii=False))
