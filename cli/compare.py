"""`goniosim compare`: published models against simulated slices."""

import contextlib
from pathlib import Path

import click

from .options import PATH, complete_models
from .policy import debug_option, say
from .signals import tidied_up, undisturbed


@click.command()
@click.argument("results", type=PATH, metavar="RESULT_OR_FOLDER")
@click.option(
    "--models",
    multiple=True,
    metavar="NAMES",
    shell_complete=complete_models,
    help="Models to compare, with commas between; may be repeated [default: all].",
)
@click.option(
    "-o",
    "--output",
    type=PATH,
    metavar="REPORT",
    help="Folder of the report [default: NAME-comparison, after the input].",
)
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="MODEL.OPTION=VALUE",
    help="Choose an option of a model, as in --set ww09.masking=correlated; may be repeated.",
)
@click.option(
    "--subcells",
    type=click.IntRange(1, 99),
    default=5,
    show_default=True,
    help="Sub-cells along each side of a cell over which models are integrated.",
)
@click.option(
    "--figures",
    type=click.Choice(["all", "overview", "none"]),
    default="all",
    show_default=True,
    help="Figures of each material: also one for each direction, only overviews, or none.",
)
@click.option("--allow-partial", is_flag=True, help="Accept results of interrupted simulations.")
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
@debug_option
def compare(results, models, output, settings, subcells, figures, allow_partial, quiet):
    """Compare published models with simulated slices.

    RESULT_OR_FOLDER is a result file, or a folder of them. Each model is integrated over the cells of
    the result, and its error is given without the noise of the simulation. The report holds tables
    (errors.csv, errors.json), the integrated slices (models.h5) and figures. `goniosim models` lists the
    models and their options.

    \b
    Example: goniosim compare patina.h5 --models ww09,bati19_ww -o report
    """  # noqa: D301
    from goniosim.compare.comparison import result_files
    from goniosim.compare.variants import check_request
    from goniosim.report.comparison import report as compare_report

    request = check_request(_names(models), _options(settings))
    paths, passed_over = result_files(results)
    materials = compare_report.check_headers(paths, allow_partial, request, figures)
    folder = Path(output or f"{Path(results).resolve().stem}-comparison")

    def report_on(message):
        if not quiet:
            say(message, err=True)

    for path in passed_over:
        report_on(f"{path}: holds integrated models, not a result; stepped over")
    options = materials, request, subcells, figures
    with tidied_up(), contextlib.closing(compare_report.Report(folder, *options)) as report:
        for number, path in enumerate(paths, 1):
            report.add(path, lambda message, n=number: report_on(f"{n}/{len(paths)} {message}"))
        text = report.finish()
        with undisturbed():
            report.commit()
    if not quiet:
        say(text)
        say(f"\n{folder}")


def _names(models):
    return [name.strip() for each in models for name in each.split(",")] if models else None


def _options(settings):
    from goniosim.errors import ConfigError

    options = {}
    for setting in settings:
        path, equals, value = setting.partition("=")
        model, dot, name = path.strip().partition(".")
        if not (equals and dot and model and name):
            raise ConfigError(f"--set {setting}: must be MODEL.OPTION=VALUE, such as ww09.masking=correlated")
        options.setdefault(model, {})[name] = value.strip()
    return options
