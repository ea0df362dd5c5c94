"""`goniosim info`: what a result file holds."""

import click

from .policy import debug_option


@click.command()
@click.argument("file")
@click.option("--json", "as_json", is_flag=True, help="Print everything as JSON, for programs.")
@debug_option
def info(file, as_json):
    """Show what the result FILE holds.

    Status, albedo of each component, energy audit, cost, effects simulated, origin.
    """
    import json
    import os

    from goniosim.report import text
    from goniosim.report.simulation import summary
    from goniosim.store import open_result

    result = open_result(file)
    if as_json:
        click.echo(json.dumps(summary.as_data(result), indent=1, allow_nan=False))
    else:
        click.echo(f"{file}  ({text.size(os.path.getsize(file))})")
        click.echo(summary.description(result))
