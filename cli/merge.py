"""`goniosim merge`: from shards to results, and from results to better ones."""

from pathlib import Path

import click

from .options import PATH, Count
from .policy import debug_option, say, say_error


@click.command()
@click.argument("sources", type=PATH, nargs=-1, required=True)
@click.option(
    "-o", "--output", type=PATH, required=True, metavar="OUT", help="Result file, or the folder of a study's files."
)
@click.option("--allow-missing", is_flag=True, help="Join what is there; the results say what is missing.")
@click.option("--only", multiple=True, metavar="MATERIAL", help="Only this material; may be repeated.")
@click.option("--threads", type=Count(), metavar="N", help="Threads to use.")
@click.option("--overwrite", is_flag=True, help="Replace results of other scenes, or with more rays.")
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
@debug_option
@click.pass_context
def merge(ctx, sources, output, allow_missing, only, threads, overwrite, quiet):
    """Join the shards of a folder, or results of different seeds.

    SOURCES is the folder of `goniosim simulate --shard`: the numbers are those of one run to the last bit, whatever the
    number of shards. If some are missing, not finished or damaged, they are named as a list for --array, nothing is
    written, and the exit code is 8. A target that its limits cut short is exit code 9, as of a plain run.

    Or SOURCES are result files of the same scene, each simulated with a --seed of its own: the result has the rays of
    all of them. Those with a seed in common are not independent, which is exit code 8.

    \b
    Examples: goniosim merge shards -o out
              goniosim merge shards -o out --allow-missing
              goniosim merge seed1.h5 seed2.h5 -o better.h5
    """  # noqa: D301
    if output == "-":
        raise click.UsageError("a result is a file, not a stream: name it with -o")
    from goniosim.cluster import merge as join
    from goniosim.cluster import merge_results
    from goniosim.errors import TARGET_NOT_REACHED
    from goniosim.report.progress import make_progress
    from goniosim.report.simulation import study, target
    from goniosim.report.simulation.summary import summary
    from goniosim.scene import parse_scene

    from .signals import tidied_up

    if not Path(sources[0]).is_dir() and (len(sources) > 1 or Path(sources[0]).is_file()):
        _check_results(sources, allow_missing or only or threads)
        with tidied_up():
            result = merge_results(sources, output, overwrite=overwrite)
        if not quiet:
            say(summary(result, output))
        return
    if len(sources) > 1:
        raise click.UsageError(
            "these are folders: shards are merged from one folder at a time, and results file by file, such as "
            f"{Path(sources[0]) / 'NAME.h5'} {Path(sources[1]) / 'NAME.h5'}"
        )
    progress = make_progress(None, quiet)
    with tidied_up():
        given = {"allow_missing": allow_missing, "overwrite": overwrite, "only": only, "threads": threads}
        rows, missed, last = [], [], None
        for result, path in join(sources[0], output, note=progress.note, **given):
            last = summary(result, path)
            rows.append(study.row(result, path))
            if result.target_reached is False and result.status == "complete":
                missed.append(f"{path}: {target.shortfall(parse_scene(result.config_yaml).simulation, result)}")
    if not quiet and rows:
        say(study.study_text(rows) if len(rows) > 1 else last)
    for line in missed:
        say_error(line)
    if missed:
        ctx.exit(TARGET_NOT_REACHED)


def _check_results(sources, of_shards):
    if len(sources) == 1:
        raise click.UsageError(f"{sources[0]} is a single file: name two results or more, or a folder of shards")
    if of_shards:
        raise click.UsageError("--allow-missing, --only and --threads go with a folder of shards, and these are files")
