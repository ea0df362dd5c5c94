"""`goniosim plot`: pictures of a result file."""

import click

from .options import PATH, Real, complete_models
from .policy import debug_option


@click.command()
@click.argument("file", type=PATH)
@click.option("-o", "--output", type=PATH, metavar="DIR", default=".", help="Folder for the pictures [default: here].")
@click.option(
    "--format",
    "suffix",
    type=click.Choice(["png", "svg", "pdf"]),
    default="png",
    show_default=True,
    help="File format.",
)
@click.option(
    "--theta",
    type=Real(),
    multiple=True,
    metavar="DEG",
    help="Only this incident direction, in degrees; may be repeated.",
)
@click.option(
    "--material", "materials", multiple=True, metavar="NAME", help="Of models.h5: only this material; may be repeated."
)
@click.option(
    "--model",
    "models",
    multiple=True,
    metavar="NAME",
    shell_complete=complete_models,
    help="Of models.h5: this model alone; may be repeated.",
)
@debug_option
def plot(file, output, suffix, theta, materials, models):
    """Draw the slices in a result file.

    Of a result FILE an overview, and one figure per incident direction: each component is seen from above in colour and
    as bands of equal luminance, and along the plane of incidence with its noise.

    Of a file of integrated models (models.h5): for each material lobes and views of all models side by
    side, and one figure per direction if there are few materials or one is chosen by --material. With
    --model that model alone, as a result is drawn.

    \b
    Examples: goniosim plot patina.h5 -o pictures
              goniosim plot patina.h5 --theta 60 --format pdf
    """  # noqa: D301
    from pathlib import Path

    from goniosim.store import may_be_models_file
    from goniosim.writing import printable

    options = {"suffix": suffix, "theta_deg": theta or None}
    if may_be_models_file(file):
        draw = _draw_models
        options |= {"materials": materials, "labels": models}
    elif materials or models:
        raise click.UsageError("--material and --model are for a file of integrated models (models.h5)")
    else:
        draw = _draw_result
    for path in draw(file, Path(output), Path(file).stem, options):
        click.echo(printable(path))


def _draw_result(file, folder, stem, options):
    from goniosim.report.memory import memory_to_plot, require_memory
    from goniosim.report.simulation.figures import draw
    from goniosim.store import open_result, read_scene

    needed = memory_to_plot(read_scene(file), overview=options["theta_deg"] is None)
    require_memory(file, needed, "use a machine with more memory, or simulate fewer incident directions per file")
    return draw(open_result(file), folder, stem, **options)


def _draw_models(file, folder, stem, options):
    from goniosim.report.integrated.figures import draw
    from goniosim.store import open_models

    with open_models(file) as models:
        yield from draw(models, folder, stem, **options)
