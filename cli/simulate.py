"""`goniosim simulate`: from a scene file to result files."""

import contextlib
from pathlib import Path

import click

from .options import PATH, Count, Quantity, overrides_of, seconds_of, set_option, simulation_options
from .planning import plan_in
from .policy import debug_option, say, say_error
from .signals import StopSignals, told_to_stop_early


@click.command()
@click.argument("config", type=PATH)
@click.option(
    "-o",
    "--output",
    type=PATH,
    metavar="OUT",
    help="Result file, or the folder of a study's files [default: the name of the material or study; of shards, with "
    ".shards behind it].",
)
@simulation_options
@click.option("--seed", type=Count(), metavar="S", help="Seed of the random numbers.")
@set_option
@click.option(
    "--checkpoint",
    type=Quantity("time", "TimeSpan"),
    default="60s",
    metavar="TIME",
    help="Keep what was gathered every so often: 30s, 10m [default: 60s].",
)
@click.option(
    "--time-limit",
    type=Quantity("time", "TimeSpan"),
    metavar="TIME",
    help="Stop after so long, keep what was gathered, and exit with 75: 55m, 23h50m.",
)
@click.option("--only", multiple=True, metavar="MATERIAL", help="Of a study, only this material; may be repeated.")
@click.option("--shard", metavar="K/N", help="Only the K-th of N equal shares of the work, into the folder OUT: 3/16.")
@click.option(
    "--dask",
    metavar="ADDRESS",
    help="Trace on the workers of this dask scheduler, such as tcp://HOST:8786; local starts some on this machine.",
)
@click.option("--overwrite", is_flag=True, help="Replace results of other scenes, or with more rays, without asking.")
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
@click.option("-v", "--verbose", is_flag=True, help="Also show effects and compilation time.")
@debug_option
@click.pass_context
def simulate(
    ctx, config, output, overrides, checkpoint, time_limit, only, shard, dask, overwrite, quiet, verbose, **asked
):
    """Simulate a scene or study file and write the result.

    CONFIG is the file, or - for the standard input. A study writes one file per material into a folder.
    A file that holds the rays or the accuracy asked for, or more, stays as it is; one with less goes
    on from what it holds; the result of another scene is an error. Ctrl-C, a signal of a batch system or --time-limit
    stop within two seconds and keep what was gathered, marked as partial: the same command goes on from
    there, to the same numbers as without the interruption. A target that --max-rays or --max-time cut
    short leaves a result, and exit code 9.

    With --shard the folder OUT takes one share of the work, for `goniosim merge` to join with the others. In a task
    of a Slurm array auto/16 takes the number from SLURM_ARRAY_TASK_ID; the count may be left out where OUT holds
    the plan of `goniosim plan`, and then CONFIG may be that folder too.

    With --dask the work is cut into shards too, which lie in OUT.shards until all are traced and merged into OUT. The
    workers have to see that folder. Each shard takes one thread, or as many as --threads says.

    \b
    Examples: goniosim simulate quickstart.yaml
              goniosim simulate quickstart.yaml --rays 1e7 --set simulation.orders=3
              goniosim simulate quickstart.yaml --target 1% --max-time 10m
              goniosim simulate study.yaml --shard 3/16 -o shards
              goniosim simulate study.yaml --dask tcp://10.0.0.1:8786 -o out
    """  # noqa: D301
    if output == "-":
        raise click.UsageError("a result is a file, not a stream: name it with -o")
    ctx.call_on_close(told_to_stop_early())
    from goniosim.engine import require_memory
    from goniosim.errors import TARGET_NOT_REACHED
    from goniosim.report.progress import make_progress
    from goniosim.report.simulation import study, target
    from goniosim.report.simulation.summary import summary
    from goniosim.scene import load_config, total_rays

    from . import jobs, shards, spreading

    if shard is not None:
        if dask is not None:
            raise click.UsageError("--dask traces all shards: leave out --shard")
        if overwrite:
            raise click.UsageError("--overwrite does not go with --shard: remove what is to be made anew")
        described = shards.only(shards.load(config, overrides, asked), only)
        home = output or (config if Path(config).is_dir() else None)
        times = seconds_of(time_limit), seconds_of(checkpoint)
        ctx.exit(shards.trace(described, shard, home, *times, quiet, verbose))
    if Path(config).is_dir() and plan_in(config) is not None:
        raise click.UsageError(f"{config} is a folder of shards: say which with --shard, or name a scene or study file")
    described = shards.only(load_config(config, [*overrides, *overrides_of(asked)]), only)
    many = described.study is not None
    planned = jobs.plan(described.scenes, output, folder=Path(output or described.study) if many else None)
    place = planned[0].path.parent if many else planned[0].path
    notes = []
    todo, missed = jobs.sort_out(planned, overwrite, notes.append)
    for job in todo:
        require_memory(job.scene)
    progress = make_progress(total_rays(job.scene for job in todo), quiet)
    done = []
    with StopSignals(seconds_of(time_limit)) as signals, contextlib.closing(progress):
        for note in notes:
            progress.note(note)
        given = progress, signals, overwrite, seconds_of(checkpoint)
        if dask is None:
            found = jobs.run(todo, *given, verbose)
        else:
            found = spreading.run(dask, described, planned, todo, place, *given)
        for job, result in found:
            done.append(study.row(result, job.path) if many else summary(result, job.path))
            if result.target_reached is False and result.status == "complete":
                missed.append(f"{job.path}: {target.shortfall(job.scene.simulation, result)}")
            del result
    if done and not quiet:
        say(study.study_text(done) if many else done[0])
    for line in missed:
        say_error(line)
    if signals.reason is not None:
        ctx.exit(signals.exit_code)
    if missed:
        ctx.exit(TARGET_NOT_REACHED)
