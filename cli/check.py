"""`goniosim check`: whether the scene is right, what it calls for, what it will cost."""

import json
from pathlib import Path

import click

from .options import PATH, overrides_of, set_option, simulation_options
from .policy import debug_option


@click.command()
@click.argument("config", type=PATH)
@click.option(
    "-o",
    "--output",
    type=PATH,
    metavar="OUT",
    help="See also whether OUT, the result file or the folder of a study, can be written and has room on its disk.",
)
@simulation_options
@set_option
@click.option(
    "-v",
    "--verbose",
    is_flag=True,
    help="Tell also what the estimators gain over independent paths, which are then tried too.",
)
@click.option("--json", "as_json", is_flag=True, help="For programs: seconds, bytes and effects as JSON.")
@debug_option
def check(config, output, overrides, verbose, as_json, **asked):
    """Validate CONFIG and predict time, file size and memory.

    CONFIG is a scene or a study file, or - for the standard input. The time is predicted from a short
    probe of the speed here; file size and memory are upper estimates. Nothing is written.

    \b
    Examples: goniosim check quickstart.yaml
              goniosim check quickstart.yaml --rays 1e8 --json
    """  # noqa: D301
    from goniosim.report.simulation import forecast
    from goniosim.scene import load_config

    from . import jobs

    described = load_config(config, [*overrides, *overrides_of(asked)])
    scenes, many = described.scenes, described.study is not None
    if output:
        jobs.require_room(jobs.plan(scenes, output, folder=Path(output) if many else None))
    made = forecast.forecasts(scenes, gains=verbose)
    if as_json:
        answer = forecast.study_as_dict(described.study, scenes, made) if many else forecast.as_dict(*scenes, *made)
        click.echo(json.dumps(answer, indent=2, allow_nan=False))
        return
    if not many:
        click.echo(forecast.effects_text(scenes[0]))
        click.echo("")
    click.echo(forecast.cost_text(made))
    if output:
        click.echo(f"  {output} can be written, and there is room for it.")
