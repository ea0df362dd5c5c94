"""`goniosim simulate`: from a scene file to result files."""

import contextlib
from pathlib import Path

import click

from .options import PATH, Count, overrides_of, rays_option, set_option, threads_option
from .policy import debug_option, say
from .signals import StopSignals


@click.command()
@click.argument("config", type=PATH)
@click.option(
    "-o",
    "--output",
    type=PATH,
    metavar="OUT",
    help="Result file, or the folder of a study's files [default: the name of the material or study].",
)
@rays_option
@click.option("--seed", type=Count(), metavar="S", help="Seed of the random numbers.")
@threads_option
@set_option
@click.option("--overwrite", is_flag=True, help="Replace results of other scenes, or with more rays, without asking.")
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
@click.option("-v", "--verbose", is_flag=True, help="Also show effects and compilation time.")
@debug_option
@click.pass_context
def simulate(ctx, config, output, rays, seed, threads, overrides, overwrite, quiet, verbose):
    """Simulate a scene or study file and write the result.

    CONFIG is the file, or - for the standard input. A study writes one file per material into a folder.
    A file that holds the rays asked for, or more, stays as it is; one with fewer is replaced; the result
    of another scene is an error. Ctrl-C stops within two seconds and keeps what was gathered, marked as
    partial.

    \b
    Examples: goniosim simulate quickstart.yaml
              goniosim simulate quickstart.yaml --rays 1e7 --set simulation.orders=3
    """  # noqa: D301
    if output == "-":
        raise click.UsageError("a result is a file, not a stream: name it with -o")
    from goniosim.engine import require_memory
    from goniosim.report.progress import make_progress
    from goniosim.report.simulation import study
    from goniosim.report.simulation.summary import summary
    from goniosim.scene import load_config

    from . import jobs

    described = load_config(config, [*overrides, *overrides_of(rays=rays, seed=seed, threads=threads)])
    many = described.study is not None
    planned = jobs.plan(described.scenes, output, folder=Path(output or described.study) if many else None)
    notes = []
    todo = jobs.sort_out(planned, overwrite, notes.append)
    for job in todo:
        require_memory(job.scene)
    progress = make_progress(sum(job.rays for job in todo), quiet)
    done = []
    with StopSignals() as signals, contextlib.closing(progress):
        for note in notes:
            progress.note(note)
        for job, result in jobs.run(todo, progress, signals, verbose, overwrite):
            done.append(study.row(result, job.path) if many else summary(result, job.path))
            del result
    if done and not quiet:
        say(study.study_text(done) if many else done[0])
    if signals.signum is not None:
        ctx.exit(signals.exit_code)
