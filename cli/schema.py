"""`goniosim schema`: the format of scene files for editors."""

import click

from .policy import debug_option


@click.command()
@debug_option
def schema():
    """Print the JSON Schema of scene files, for editors.

    An editor completes and checks a scene file whose first line names it.

    \b
    Example: goniosim schema > scene.schema.json
    First line of a scene file: # yaml-language-server: $schema=scene.schema.json
    """  # noqa: D301
    import json

    from goniosim.scene import json_schema

    click.echo(json.dumps(json_schema(), indent=2, ensure_ascii=False))
