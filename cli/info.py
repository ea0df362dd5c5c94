"""`goniosim info`: what a result file holds."""

import click

from .options import PATH
from .policy import debug_option, say, say_error


@click.command()
@click.argument("paths", nargs=-1, required=True, type=PATH, metavar="FILE_OR_FOLDER...")
@click.option("--json", "as_json", is_flag=True, help="Print everything as JSON, for programs.")
@debug_option
@click.pass_context
def info(ctx, paths, as_json):
    """Show what result files hold.

    Of one FILE: status, albedo of each component, energy audit, cost, effects simulated, origin; every
    byte is checked. Of a file of integrated models (models.h5): materials, models with their options,
    components, origin.

    Of a FOLDER, or of several files: a table with a line for each, from what stands at their head.
    Damaged ones are named, and the exit code is 6.

    \b
    Examples: goniosim info patina.h5
              goniosim info metals/
    """  # noqa: D301
    import json
    import os

    from goniosim.report import text
    from goniosim.store import may_be_models_file
    from goniosim.writing import printable

    if len(paths) > 1 or os.path.isdir(paths[0]):
        _table(ctx, paths, as_json)
        return
    (file,) = paths
    show = _models if may_be_models_file(file) else _result
    if as_json:
        click.echo(json.dumps(show(file, as_json), indent=1, allow_nan=False))
    else:
        description = show(file, as_json)
        say(f"{printable(file)}  ({text.size(os.path.getsize(file))})")
        say(description)


def _table(ctx, paths, as_json):
    import json

    from goniosim.report import listing

    entries, errors = listing.listing(paths)
    if as_json:
        click.echo(json.dumps(entries, indent=1))
    else:
        say(listing.description(entries))
    for error in errors:
        say_error(f"error: {error}")
    if errors:
        ctx.exit(max(error.exit_code for error in errors))


def _result(file, as_json):
    from goniosim.report.simulation import summary
    from goniosim.store import open_result

    result = open_result(file)
    return summary.as_data(result) if as_json else summary.description(result)


def _models(file, as_json):
    from goniosim.report.integrated import summary
    from goniosim.store import open_models

    with open_models(file) as models:
        return summary.as_data(models) if as_json else summary.description(models)
