"""`goniosim check`: whether the scene is right, what it calls for, what it will cost."""

import json
from pathlib import Path

import click

from .options import Count, set_option
from .policy import debug_option


@click.command()
@click.argument("config")
@click.option(
    "-o",
    "--output",
    metavar="OUT",
    help="See also whether OUT, the result file or the folder of a study, can be written and has room on its disk.",
)
@click.option("--rays", type=Count(), metavar="N", help="Rays per incident direction, such as 1e7.")
@click.option("--threads", type=click.IntRange(min=1), metavar="T", help="Threads; all cores by default.")
@set_option
@click.option("--json", "as_json", is_flag=True, help="For programs: seconds, bytes and effects as JSON.")
@debug_option
def check(config, output, rays, threads, overrides, as_json):
    """Validate CONFIG and predict time, file size and memory.

    CONFIG is a scene or a study file. The time is predicted from a short probe of the speed here; file size and
    memory are upper estimates. Nothing is written.
    """
    from goniosim.report.simulation import forecast
    from goniosim.scene import is_study, load_scenes, study_name

    from . import jobs

    given = {"rays": rays, "threads": threads}
    options = [f"simulation.{name}={value}" for name, value in given.items() if value is not None]
    scenes = load_scenes(config, [*overrides, *options])
    many = is_study(config)
    if output:
        jobs.require_room(scenes, Path(output), many)
    made = forecast.forecasts(scenes)
    if as_json:
        answer = forecast.study_as_dict(study_name(config), scenes, made) if many else forecast.as_dict(*scenes, *made)
        click.echo(json.dumps(answer, indent=2, allow_nan=False))
        return
    if not many:
        click.echo(forecast.effects_text(scenes[0]))
        click.echo("")
    click.echo(forecast.cost_text(made))
    if output:
        click.echo(f"  {output} can be written, and there is room for it.")
