"""`goniosim check`: whether the scene is right, what it calls for, what it will cost."""

import click

from .options import set_option
from .policy import debug_option


@click.command()
@click.argument("config")
@set_option
@debug_option
def check(config, overrides):
    """Validate CONFIG and predict time and file size.

    CONFIG is a scene or a study file. The time is predicted from a short probe of the speed here.
    """
    from goniosim.report.simulation import forecast
    from goniosim.scene import load_scenes

    scenes = load_scenes(config, overrides)
    if len(scenes) == 1:
        click.echo(forecast.effects_text(scenes[0]))
        click.echo("")
    click.echo(forecast.cost_text(forecast.forecasts(scenes)))
