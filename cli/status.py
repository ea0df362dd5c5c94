"""`goniosim status`: how far the shards of a folder are."""

import click

from .options import PATH
from .policy import debug_option, say


@click.command()
@click.argument("folder", type=PATH)
@click.option("--json", "as_json", is_flag=True, help="Print everything as JSON, for programs.")
@debug_option
def status(folder, as_json):
    """Show how far the shards of a FOLDER are.

    FOLDER is that of `goniosim plan`, `goniosim submit` or `goniosim simulate --shard`. Shards are done,
    running, stopped (the same shard again goes on), missing, or failed with what they said; then the light
    paths that they hold, and the time that is left at the rate of what is done; and merged results with
    their noise, where they stand.

    \b
    Examples: goniosim status shards
              goniosim status shards --json
    """  # noqa: D301
    import json

    from goniosim.cluster import words
    from goniosim.cluster.slurm import results_of
    from goniosim.cluster.status import look
    from goniosim.store import open_result

    found = look(folder)
    results = {path: open_result(path) for path in results_of(found.plan, folder) if path.exists()}
    if as_json:
        click.echo(json.dumps(words.status_as_data(found, results), indent=1, allow_nan=False))
    else:
        say(words.status_text(found, results))
