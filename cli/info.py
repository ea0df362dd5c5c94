"""`goniosim info`: what a result file holds."""

import click

from .policy import debug_option, say


@click.command()
@click.argument("file")
@click.option("--json", "as_json", is_flag=True, help="Print everything as JSON, for programs.")
@debug_option
def info(file, as_json):
    """Show what the result FILE holds.

    Status, albedo of each component, energy audit, cost, effects simulated, origin. Of a file of
    integrated models (models.h5): materials, models with their options, components, origin.
    """
    import json
    import os

    from goniosim.report import text
    from goniosim.store import may_be_models_file
    from goniosim.writing import printable

    show = _models if may_be_models_file(file) else _result
    if as_json:
        click.echo(json.dumps(show(file, as_json), indent=1, allow_nan=False))
    else:
        description = show(file, as_json)
        say(f"{printable(file)}  ({text.size(os.path.getsize(file))})")
        say(description)


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
