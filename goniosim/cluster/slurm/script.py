"""The scripts of a plan: what the templates beside this file become."""

import math
import re
import shlex
import sys
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from goniosim.errors import OutputError, RefusalError

SHARDS, MERGE = "shards.sbatch", "merge.sbatch"
# Where a plan's folder has the output of jobs, and the result.
LOGS, RESULTS = "logs", "results"
# Seconds before the end of the time in which a shard writes what it has, or a part of a short time.
NOTICE, SHARE = 120, 4
# What is allotted above the memory that is predicted: that is an upper estimate, and running out of it ends a task.
_SPARE = 1.2
_MEBIBYTE = 2**20


@dataclass(frozen=True)
class Jobs:
    """A job array of shards, and the merge after it.

    Attributes
    ----------
    name : str
        Of the study or the material.
    folder, out : Path
        Of the plan, and where the merged result goes.
    shards : int
    cpus : int
        Of a task.
    n_bytes : int
        Memory that a task takes.
    walltime : float
        Seconds that a task may take.
    options : tuple of str
        For both jobs, as `sbatch` takes them.
    """

    name: str
    folder: Path
    out: Path
    shards: int
    cpus: int
    n_bytes: int
    walltime: float
    options: tuple


def result_of(plan, folder):
    """Where the merged result of a plan in a folder goes: a file of a scene, a folder of a study."""
    return Path(folder) / RESULTS if plan.study is not None else results_of(plan, folder)[0]


def results_of(plan, folder):
    """Where the merged results of all materials of a plan go, list of Path."""
    return [Path(folder) / RESULTS / f"{scene.material.name}.h5" for scene in plan.scenes]


def scripts(jobs):
    """Fill in the templates.

    Parameters
    ----------
    jobs : Jobs

    Returns
    -------
    dict of str to str
        Text by file name.

    Raises
    ------
    OutputError
        If the name of a folder cannot stand in a script.
    RefusalError
        If the command that the scripts are to call is not there.
    """
    folder, out = jobs.folder.absolute(), jobs.out.absolute()
    minutes = max(1, math.ceil(jobs.walltime / 60.0))
    found = {
        "name": _quoted(jobs.name),
        "shards": str(jobs.shards),
        "cpus": str(jobs.cpus),
        "megabytes": str(math.ceil(_SPARE * jobs.n_bytes / _MEBIBYTE)),
        "time": f"{minutes // 1440}-{minutes // 60 % 24:02}:{minutes % 60:02}:00",
        "notice": str(min(NOTICE, 60 * minutes // SHARE)),
        # In names of logs, % begins the number of a task.
        "logs": _quoted(str(folder / LOGS).replace("%", "%%")),
        "options": " ".join(["#SBATCH", *map(_quoted, jobs.options)]) if jobs.options else "",
        "folder": _quoted(folder),
        "out": _quoted(out),
        "goniosim": _quoted(_program()),
    }
    templates = {name: (files(__package__) / name).read_text(encoding="utf-8") for name in (SHARDS, MERGE)}
    return {
        name: re.sub(r"\{\{(\w+)\}\}\n?", lambda match: _filled(match, found), text) for name, text in templates.items()
    }


def _filled(match, found):
    value = found[match[1]]
    return value + ("\n" if match[0].endswith("\n") and value else "")


def _quoted(text):
    """Text as one word, for bash and for `sbatch`, which reads its lines much as bash does."""
    text = str(text)
    if not text.isprintable() or "\\" in text:
        raise OutputError(f"{text!r} cannot stand in a batch script: choose a name without backslashes and line breaks")
    return shlex.quote(text)


def _program():
    """The command of the environment that this process belongs to."""
    program = Path(sys.executable).absolute().with_name("goniosim")
    if not program.exists():
        raise RefusalError(f"{program} is missing, and batch scripts call it: install goniosim into this environment")
    return program
