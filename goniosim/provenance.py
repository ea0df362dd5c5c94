"""With what a number was computed: versions, machine, threads, time and the command that asked for it."""

import contextlib
import os
import platform
import shlex
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from functools import cache
from pathlib import Path

from .cores import available_cores

# Longer commands are cut: an attribute of a file is no place for them.
LONGEST_COMMAND = 2000
_CPUINFO = Path("/proc/cpuinfo")
_ROOT = Path(__file__).resolve().parent.parent

_commands: list[str] = []


def provenance(threads: int) -> dict[str, str]:
    """Provenance of a result or a report.

    Parameters
    ----------
    threads : int

    Returns
    -------
    dict of str to str
        Without ``command`` where Python called, and without ``git_revision`` of an installed goniosim.
    """
    known = {
        "created_utc": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "goniosim_version": version_of("goniosim"),
        "git_revision": git_revision(),
        "command": _commands[-1] if _commands else None,
        "numba_version": version_of("numba"),
        "numpy_version": version_of("numpy"),
        "python_version": platform.python_version(),
        "operating_system": operating_system(),
        "processor": processor(),
        "cores": str(available_cores()),
        "threads": str(threads),
    }
    return {name: value for name, value in known.items() if value is not None}


@contextlib.contextmanager
def commanded(arguments: Sequence[str]) -> Iterator[None]:
    """While active, what is computed is said to come of this command line.

    Parameters
    ----------
    arguments : sequence of str
        Without the name of the program.
    """
    # Names of files may be no text at all, and what is kept here goes into text files too.
    command = shlex.join(["goniosim", *arguments]).encode("utf-8", "backslashreplace").decode()
    _commands.append(command if len(command) <= LONGEST_COMMAND else f"{command[:LONGEST_COMMAND]} ...")
    try:
        yield
    finally:
        _commands.pop()


def version_of(package: str) -> str:
    """Version of an installed package; ``unknown`` of one that is used without being installed."""
    # Not needed for help, and slow.
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"


@cache
def processor() -> str:
    """Model of the processor, or its architecture where the system tells no more."""
    with contextlib.suppress(OSError), _CPUINFO.open(encoding="utf-8", errors="replace") as lines:
        for line in lines:
            name, _, value = line.partition(":")
            if name.strip() in ("model name", "Model", "cpu model") and value.strip():
                return value.strip()
    if platform.system() == "Darwin":
        found = _said("/usr/sbin/sysctl", "-n", "machdep.cpu.brand_string")
        if found:
            return found
    return platform.processor() or platform.machine() or "unknown"


@cache
def operating_system() -> str:
    """Name and release of the system, and of the distribution if it has one."""
    system = f"{platform.system()} {platform.release()}".strip()
    with contextlib.suppress(OSError):
        return f"{system} ({platform.freedesktop_os_release()['PRETTY_NAME']})"
    return system or "unknown"


@cache
def git_revision() -> str | None:
    """Commit from which goniosim runs, with ``-dirty`` if its files were changed since.

    Returns
    -------
    str or None
        None of an installed goniosim, even if that lies inside somebody's repository, and without git.
    """
    if not (_ROOT / ".git").exists() or not _is_goniosim(_ROOT):
        return None
    return _said("git", "-C", str(_ROOT), "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*")


def _is_goniosim(root: Path) -> bool:
    try:
        return '\nname = "goniosim"\n' in (root / "pyproject.toml").read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return False


def _said(*command: str) -> str | None:
    """What a program prints, or None if it cannot or will not."""
    import subprocess

    # In a hook of another repository, these variables would send git there.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    try:
        run = subprocess.run(
            command,
            env=environment | {"GIT_OPTIONAL_LOCKS": "0"},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=2.0,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    said = run.stdout.decode(errors="replace").strip()
    return said if run.returncode == 0 and said else None
