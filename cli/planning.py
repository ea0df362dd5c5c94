"""What `goniosim plan` and `goniosim submit` share: their options, and a plan in its folder."""

from pathlib import Path

import click

from .options import MEASURE_OPTIONS, Count, Quantity, overrides_of, seconds_of, set_option, with_options

OPTIONS = (
    click.option(
        "--walltime",
        type=Quantity("time", "TimeSpan"),
        metavar="TIME",
        help="Time that a task may take: 30m, 2h, 1h30m [default: 1h].",
    ),
    click.option(
        "--shards",
        type=click.IntRange(min=1),
        metavar="N",
        help="Tasks to cut the work into [default: each fills a good part of its time].",
    ),
    click.option(
        "--cpus",
        type=click.IntRange(min=1),
        metavar="C",
        help="Processors, and so threads, of a task [default: those of this machine, at most 8].",
    ),
    *MEASURE_OPTIONS,
    click.option("--seed", type=Count(), metavar="S", help="Seed of the random numbers."),
    set_option,
)


def _passed_on(ctx, param, words):
    if words and not words[0].startswith("-"):
        raise click.UsageError(f"Got unexpected extra argument ({words[0]}); options of sbatch stand behind --")
    return words


sbatch_options = click.argument(
    "sbatch_options", nargs=-1, type=click.UNPROCESSED, callback=_passed_on, metavar="[-- SBATCH_OPTIONS]"
)


def planning_options(command):
    """Add the options that say what is to be planned."""
    return with_options(command, OPTIONS)


def described_by(config, overrides, asked):
    """What CONFIG and options describe, see `goniosim.scene.load_config`."""
    from goniosim.scene import load_config

    return load_config(config, [*overrides, *overrides_of(asked)])


def look_ahead(described, walltime, shards, cpus, there=None):
    """Predict what scenes take as a job array; see `goniosim.cluster.outlook.look_ahead`.

    Parameters
    ----------
    described : goniosim.scene.Config
    walltime, shards, cpus : str or int, or None
        As given by the user.
    there : goniosim.cluster.ShardPlan, optional
        That of a folder, whose number of shards is kept if no other is given.
    """
    from goniosim.cluster import outlook

    if shards is None and there is not None:
        shards = there.shards
    return outlook.look_ahead(
        described.scenes,
        described.study,
        cpus=cpus or outlook.usual_cpus(),
        walltime=seconds_of(walltime or "1h"),
        shards=shards,
    )


def plan_in(folder):
    """The plan that stands in a folder, None without one."""
    from goniosim.cluster import ShardPlan

    return ShardPlan.find(folder)


def write(outlook, folder, options):
    """Write a plan and its batch scripts into a folder."""
    from goniosim.cluster import plan_of
    from goniosim.cluster.slurm import LOGS, Jobs, result_of, scripts
    from goniosim.writing import make_folder, write_text

    folder = Path(folder).absolute()
    jobs = Jobs(
        folder=folder,
        out=result_of(outlook.plan, folder),
        shards=outlook.plan.shards,
        name=outlook.plan.study or outlook.plan.scenes[0].material.name,
        cpus=outlook.cpus,
        n_bytes=outlook.n_bytes,
        walltime=outlook.walltime,
        options=tuple(options),
    )
    texts = scripts(jobs)
    plan_of(folder, outlook.plan)
    make_folder(folder / LOGS)
    for name, content in texts.items():
        write_text(folder / name, content)
