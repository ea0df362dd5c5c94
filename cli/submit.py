"""`goniosim submit`: a study, or what is missing of it, handed to a batch system."""

from pathlib import Path

import click

from .options import PATH
from .planning import described_by, look_ahead, plan_in, planning_options, sbatch_options, write
from .policy import debug_option, say


@click.command()
@click.argument("config", type=PATH)
@click.option(
    "-o",
    "--output",
    type=PATH,
    metavar="DIR",
    help="Folder for the plan, its scripts and its shards [default: NAME.shards].",
)
@click.option("--slurm", is_flag=True, help="To Slurm, by sbatch.")
@planning_options
@sbatch_options
@debug_option
def submit(config, output, slurm, walltime, shards, cpus, overrides, sbatch_options, **asked):
    """Submit CONFIG as a job array, with the merge that follows it.

    CONFIG is a scene or a study file; it is planned as by `goniosim plan` into DIR. If DIR has its plan
    already, or CONFIG is such a folder, the scripts there are taken as they are (so without --walltime and
    --cpus), and only shards that are neither done nor running are submitted. What stands behind -- are options
    of sbatch.

    \b
    Examples: goniosim submit study.yaml --slurm --walltime 2h -o shards -- --partition=long
              goniosim submit shards --slurm
    """  # noqa: D301
    from goniosim.cluster.slurm import LOGS, result_of
    from goniosim.cluster.slurm import submit as hand_over
    from goniosim.cluster.status import Stage, look
    from goniosim.report.text import counted

    if not slurm:
        raise click.UsageError("to which batch system? Say --slurm")
    there = plan_in(config) if config != "-" else None
    if there is not None:
        given = {"output": output, "walltime": walltime, "shards": shards, "cpus": cpus, "set": overrides}
        _refuse_changes(config, {**asked, **given})
        folder = Path(config)
    else:
        described = described_by(config, overrides, asked)
        folder = Path(output or f"{described.study or described.scenes[0].material.name}.shards")
        there = plan_in(folder)
        if there is None:
            outlook = look_ahead(described, walltime, shards, cpus)
            write(outlook, folder, sbatch_options)
            there, sbatch_options = outlook.plan, ()
        else:
            _refuse_changes(folder, {"walltime": walltime, "cpus": cpus})
            there.require_same(there.make(described.scenes, described.study, shards or there.shards), folder)
    there.require_version(folder)
    # What the merge has found to be damaged is to be run again.
    found = look(folder, whole=True)
    numbers = [shard.number for shard in found.of(Stage.MISSING, Stage.STOPPED, Stage.FAILED)]
    out = result_of(there, folder)
    if not numbers:
        running = len(found.of(Stage.RUNNING))
        what = f"{counted(running, 'shard')} running, the others done" if running else "all shards are done"
        say(f"{folder}: {what}: nothing to submit\n  merge    goniosim merge {_quoted(folder)} -o {_quoted(out)}")
        return
    job, merge = hand_over(folder.absolute(), numbers, sbatch_options)
    say(f"{counted(len(numbers), 'shard')} of {there.shards} submitted as job {job}, their merge as job {merge}")
    say(f"  status   goniosim status {_quoted(folder)}\n  logs     {folder / LOGS}\n  result   {out}")


def _quoted(path):
    import shlex

    return shlex.quote(str(path))


def _refuse_changes(folder, given):
    names = [f"--{name.replace('_', '-')}" for name, value in given.items() if value]
    if names:
        raise click.UsageError(
            f"{folder} has its plan already, which takes no {', '.join(names)}: "
            "edit its scripts, or give options of sbatch behind --, or plan anew into another folder"
        )
