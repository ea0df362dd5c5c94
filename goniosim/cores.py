"""How many processors there are to share the work, and how many threads the system grants."""

import math
import os
import re
import threading
from collections.abc import Iterator, Mapping
from pathlib import Path

from .containers import groups, text
from .errors import RefusalError

# Who allots processors, the most particular first: the batch system's share of a task, then what is asked of
# all programs, or of those with Numba.
ALLOTMENTS = ("SLURM_CPUS_PER_TASK", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS")


def available_cores(environment: Mapping[str, str] = os.environ, root: Path = Path("/")) -> int:
    """Cores this process may use: what is allotted to it, else what its container may take; of those it may run on.

    Parameters
    ----------
    environment : mapping of str to str
        Where `ALLOTMENTS` are looked up; what is no number above 0 is passed over.
    root : Path
        Where ``proc`` and ``sys`` are.

    Returns
    -------
    int
    """
    # OpenMP takes a list with a number for each level.
    written = (re.match(r"\s*0*([1-9]\d{0,8})\s*(,|$)", environment.get(name, "")) for name in ALLOTMENTS)
    allotted = next((int(found[1]) for found in written if found), None)
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min([usable, *_quotas(root)]) if allotted is None else min(usable, allotted)


def _quotas(root: Path) -> Iterator[int]:
    """Processors worth of time that this process's group and those around it may take, rounded up."""
    for folder, is_first in groups("cpu", root):
        names = ("cpu.cfs_quota_us", "cpu.cfs_period_us") if is_first else ("cpu.max",)
        words = [word for name in names for word in text(folder / name).split()]
        # A group without a limit says "max", or -1.
        if len(words) == 2 and all(word.isdecimal() and int(word) > 0 for word in words):
            yield max(1, math.ceil(int(words[0]) / int(words[1])))


def granted_threads(wanted: int) -> int:
    """How many threads can be started now.

    A limit on processes, or on memory, may allow fewer than there are cores. A pool would notice only in the
    middle of its work.

    Parameters
    ----------
    wanted : int

    Returns
    -------
    int
        At least 1, at most ``wanted``.

    Raises
    ------
    RefusalError
        If not a single one can be started.
    """
    done = threading.Event()
    started: list[threading.Thread] = []
    try:
        for _ in range(wanted):
            thread = threading.Thread(target=done.wait, daemon=True)
            thread.start()
            started.append(thread)
    except (RuntimeError, MemoryError):
        # What Python says when the system starts no more of them.
        pass
    finally:
        done.set()
        for thread in started:
            thread.join()
    if not started:
        raise RefusalError(
            "the system starts no thread: raise the limit on processes (ulimit -u) or on memory (ulimit -v)"
        )
    return len(started)
