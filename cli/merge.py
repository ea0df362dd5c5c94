"""`goniosim merge`: from shards to results."""

import click

from .options import PATH, Count
from .policy import debug_option, say


@click.command()
@click.argument("folder", type=PATH)
@click.option(
    "-o", "--output", type=PATH, required=True, metavar="OUT", help="Result file, or the folder of a study's files."
)
@click.option("--allow-missing", is_flag=True, help="Join what is there; the results say what is missing.")
@click.option("--only", multiple=True, metavar="MATERIAL", help="Only this material; may be repeated.")
@click.option("--threads", type=Count(), metavar="N", help="Threads to use.")
@click.option("--overwrite", is_flag=True, help="Replace results of other scenes, or with more rays.")
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
@debug_option
def merge(folder, output, allow_missing, only, threads, overwrite, quiet):
    """Join the shards of a folder to what one run would have yielded.

    FOLDER is that of `goniosim simulate --shard`. The numbers are the same to the last bit, whatever the number of
    shards. If some are missing, not finished or damaged, they are named as a list for --array, nothing is written,
    and the exit code is 8.

    \b
    Examples: goniosim merge shards -o out
              goniosim merge shards -o out --allow-missing
    """  # noqa: D301
    from goniosim.cluster import merge as join
    from goniosim.report.progress import make_progress
    from goniosim.report.simulation import study
    from goniosim.report.simulation.summary import summary

    from .signals import tidied_up

    progress = make_progress(None, quiet)
    with tidied_up():
        given = {"allow_missing": allow_missing, "overwrite": overwrite, "only": only, "threads": threads}
        rows, last = [], None
        for result, path in join(folder, output, note=progress.note, **given):
            last = summary(result, path)
            rows.append(study.row(result, path))
    if not quiet and rows:
        say(study.study_text(rows) if len(rows) > 1 else last)
