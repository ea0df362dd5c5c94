"""`goniosim simulate`: from a scene file to result files."""

import contextlib
from pathlib import Path

import click

from .options import Count, set_option
from .policy import debug_option, say
from .signals import StopSignals


@click.command()
@click.argument("config")
@click.option(
    "-o",
    "--output",
    metavar="OUT",
    help="Result file, or the folder of a study's files [default: the name of the material or study].",
)
@click.option("--rays", type=Count(), metavar="N", help="Rays per incident direction, such as 1e7.")
@click.option("--seed", type=Count(), metavar="S", help="Seed of the random numbers.")
@click.option("--threads", type=click.IntRange(min=1), metavar="T", help="Threads; all cores by default.")
@set_option
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
@click.option("-v", "--verbose", is_flag=True, help="Also show effects and compilation time.")
@debug_option
@click.pass_context
def simulate(ctx, config, output, rays, seed, threads, overrides, quiet, verbose):
    """Simulate the scene file CONFIG and write the result.

    A study writes one file per material into a folder, and leaves alone those that an earlier run has
    finished. Ctrl-C stops within two seconds and keeps what was gathered, marked as partial.
    """
    from goniosim.report.progress import make_progress
    from goniosim.report.simulation import study
    from goniosim.report.simulation.summary import summary
    from goniosim.scene import is_study, load_scenes, study_name

    from . import jobs

    given = {"rays": rays, "seed": seed, "threads": threads}
    options = [f"simulation.{name}={value}" for name, value in given.items() if value is not None]
    scenes = load_scenes(config, [*overrides, *options])
    many = is_study(config)
    planned = jobs.plan(scenes, output, folder=Path(output or study_name(config)) if many else None)
    todo = [job for job in planned if not job.is_finished()] if many else planned
    progress = make_progress(sum(job.rays for job in todo), quiet)
    done = []
    with StopSignals() as signals, contextlib.closing(progress):
        if len(todo) < len(planned):
            progress.note(f"{len(planned) - len(todo)} of {len(planned)} materials are finished: skipped")
        for job, result in jobs.run(todo, progress, signals, verbose):
            done.append(study.row(result, job.path) if many else summary(result, job.path))
    if done and not quiet:
        say(study.study_text(done) if many else done[0])
    if signals.signum is not None:
        ctx.exit(signals.exit_code)
