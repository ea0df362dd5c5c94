"""`goniosim cost`: what accuracy costs in time."""

import click

from .options import PATH, Quantity, overrides_of, set_option
from .policy import debug_option, say
from .signals import tidied_up


@click.command()
@click.argument("config", type=PATH)
@click.option("-o", "--output", type=PATH, metavar="FOLDER", help="Folder for the figures [default: here].")
@click.option(
    "--max-time",
    type=Quantity("time", "TimeSpan"),
    default="60s",
    show_default=True,
    metavar="TIME",
    help="Time to spend on runs, about, such as 20s or 5m; compilation and --models come on top.",
)
@click.option("--models", is_flag=True, help="Add the models that apply, as points with their errors and times.")
@click.option("--threads", type=click.IntRange(min=1), metavar="T", help="Threads; all cores by default.")
@set_option
@click.option("--json", "as_json", is_flag=True, help="For programs: print JSON, and draw only with -o.")
@debug_option
def cost(config, output, max_time, models, threads, overrides, as_json):
    """Show what accuracy costs in time.

    CONFIG is a scene file, or - for the standard input. A ladder of short runs is measured with the
    estimator that goniosim chooses (auto) and with independent paths (analog). Printed are the times for
    slice errors from 10 to 0.1 %, measured or predicted; what each effect of the scene adds to the time of
    a path; and where something else limits than noise: sub-cells, cells, incident directions. NAME-cost.png
    and .svg show error against time.

    \b
    Examples: goniosim cost quickstart.yaml
              goniosim cost quickstart.yaml --max-time 5m --models -o prices
    """  # noqa: D301
    import json
    from pathlib import Path

    from goniosim.engine import require_memory
    from goniosim.errors import ConfigError
    from goniosim.report.cost import summary
    from goniosim.report.cost.price_list import price_list
    from goniosim.scene import load_config, target

    scenes = load_config(config, [*overrides, *overrides_of({"threads": threads})]).scenes
    if len(scenes) > 1:
        raise ConfigError(f"{config}: describes {len(scenes)} materials, and a price list is of one; give a scene file")
    (scene,) = scenes
    require_memory(scene)
    stem = None if as_json and output is None else Path(output or ".") / f"{scene.material.name}-cost"
    if stem is not None:
        _require_room(stem)
    with tidied_up():
        made = price_list(
            scene,
            target.TimeSpan().check(max_time),
            models,
            lambda message: say(f"{scene.material.name}: {message}", err=True),
        )
        paths = [] if stem is None else _draw(stem, made)
    if as_json:
        click.echo(json.dumps(summary.as_data(made), indent=1, allow_nan=False))
        return
    say("\n".join([summary.description(made), "", *map(str, paths)]))


def _require_room(stem):
    """Make sure, before anything is run, that the figures can be written."""
    from goniosim.report.cost.figure import SUFFIXES
    from goniosim.report.drawing.files import refuse_foreign
    from goniosim.writing import Replacement, make_folder

    make_folder(stem.parent)
    paths = [stem.with_name(f"{stem.name}.{suffix}") for suffix in SUFFIXES]
    refuse_foreign(paths)
    Replacement(paths[0]).discard()


def _draw(stem, made):
    from goniosim.report.cost.figure import SUFFIXES, price_figure
    from goniosim.report.drawing.files import write_figure

    return write_figure(stem, SUFFIXES, price_figure, made)
