"""`goniosim plan`: what a study takes as a job array, and the scripts that run it."""

from pathlib import Path

import click

from .options import PATH
from .planning import described_by, look_ahead, plan_in, planning_options, sbatch_options, write
from .policy import debug_option, say


@click.command()
@click.argument("config", type=PATH)
@click.option("-o", "--output", type=PATH, metavar="DIR", help="Write the plan and its batch scripts into this folder.")
@planning_options
@sbatch_options
@debug_option
def plan(config, output, walltime, shards, cpus, overrides, sbatch_options, **asked):
    """Plan CONFIG as a job array: its time, memory, disk and shards.

    CONFIG is a scene or a study file, or - for the standard input. Times are predicted from short probes
    of the speed here. With -o, DIR gets plan.json and two scripts for Slurm: an array with a task for each
    shard, and the merge that follows it. What stands behind -- goes into both as options of sbatch.

    \b
    Examples: goniosim plan study.yaml --walltime 2h
              goniosim plan study.yaml --rays 1e9 --cpus 8 -o shards -- --partition=long --account=me
    """  # noqa: D301
    from goniosim.cluster.slurm import commands
    from goniosim.cluster.words import outlook_text

    described = described_by(config, overrides, asked)
    outlook = look_ahead(described, walltime, shards, cpus, output and plan_in(output))
    if output:
        write(outlook, output, sbatch_options)
    say(outlook_text(outlook))
    if output:
        lines = "\n".join(f"  {line}" for line in commands(Path(output).absolute()))
        say(f"\nThe plan and its scripts are in {output}. Next:\n\n{lines}")
    else:
        say("Nothing is written; with -o DIR, the plan and scripts for Slurm are.")
