"""Jobs handed to Slurm, by its own commands."""

import shlex
import subprocess
from pathlib import Path

from goniosim.cluster.shard import array_list
from goniosim.cluster.slurm.script import MERGE, SHARDS
from goniosim.errors import RefusalError


def commands(folder):
    """What a user types to submit a folder of shards: lines for a shell.

    Parameters
    ----------
    folder : Path
    """
    shards, merge = (shlex.quote(str(folder / name)) for name in (SHARDS, MERGE))
    # Of several clusters, sbatch names the one it took behind the number.
    return [f"job=$(sbatch --parsable {shards})", f"sbatch --dependency=afterany:${{job%%;*}} {merge}"]


def submit(folder, numbers, options):
    """Submit shards, and their merge for when all of them have ended.

    Parameters
    ----------
    folder : Path
        With the scripts of a plan.
    numbers : list of int
        Of the shards.
    options : sequence of str
        For both jobs, as `sbatch` takes them.

    Returns
    -------
    str, str
        Numbers of the array and of the merge.

    Raises
    ------
    RefusalError
        If there is no `sbatch`, or it refuses.
    """
    job = _sbatch(folder, f"--array={array_list(numbers)}", *options, folder / SHARDS)
    try:
        merge = _sbatch(folder, f"--dependency=afterany:{job}", *options, folder / MERGE)
    except RefusalError as error:
        raise RefusalError(f"the shards are submitted as job {job}, but not their merge: {error}") from error
    return job, merge


def _sbatch(folder, *arguments):
    command = ["sbatch", "--parsable", *map(str, arguments)]
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
    except FileNotFoundError:
        raise RefusalError(
            "there is no sbatch here: run this where jobs are submitted, or without Slurm trace each shard by "
            f"goniosim simulate {shlex.quote(str(folder))} --shard 1, and so on"
        ) from None
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if line.strip()] or [f"exit code {done.returncode}"]
        raise RefusalError(f"sbatch refuses {Path(arguments[-1]).name}: {' / '.join(lines)}")
    return done.stdout.strip().partition(";")[0]
