"""How many processors there are to share the work, and how many threads the system grants."""

import os
import threading

from .errors import RefusalError


def available_cores() -> int:
    """Cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


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
