"""Whose a file is, and whether that process still lives: machine, start of the machine, process, lock on the file."""

import fcntl
import hashlib
import os
import platform
from pathlib import Path

# To open a file that is to be locked.
FLAGS = os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW
# State and start of a process, counted from behind its name, which may hold blanks and brackets.
_STATE, _STARTED = 0, 19


def try_lock(descriptor: int, *, shared: bool = False) -> bool | None:
    """Try to lock an open file for as long as it is open, however this process ends.

    Parameters
    ----------
    descriptor : int
    shared : bool
        Together with others who do so: enough to see whether somebody holds it for himself.

    Returns
    -------
    bool or None
        False if somebody else holds it, None where there are no locks.
    """
    try:
        fcntl.flock(descriptor, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True


def runs(pid: int, started: str = "") -> bool:
    """Whether a process of this machine lives.

    Parameters
    ----------
    pid : int
    started : str
        See `start_of`; without it another process may have the number by now.
    """
    try:
        os.kill(pid, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        pass
    state, now = _stat(pid)
    return state != "Z" and not (started and now and started != now)


def start_of(pid: int) -> str:
    """When a process of this machine was started, in a unit of the system; empty where it does not tell."""
    return _stat(pid)[1]


def host() -> str:
    """Name of this machine, as short as a part of a file name has to be."""
    return short(platform.node())


def boot() -> str:
    """Which start of which machine this is; where the system does not say, the machine."""
    try:
        return short(Path("/proc/sys/kernel/random/boot_id").read_text())
    except OSError:
        return host()


def numbering() -> str:
    """Which processes have numbers of their own, as those of a container do; empty where the system does not say."""
    try:
        return os.readlink("/proc/self/ns/pid")
    except OSError:
        return ""


def short(text: str) -> str:
    """Eight hexadecimal digits that stand for a text."""
    return hashlib.sha256(os.fsencode(text)).hexdigest()[:8]


def _stat(pid: int) -> tuple[str, str]:
    try:
        fields = Path(f"/proc/{pid}/stat").read_text(errors="replace").rpartition(")")[2].split()
        return fields[_STATE], fields[_STARTED]
    except (OSError, IndexError):
        return "", ""
