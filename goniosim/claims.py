"""Claims on output paths, ``.NAME.HASH.claim``: who is at work on what. They die with their owner.

A claim is a file that only one process can create. What it says of its owner, a lock on it and its time tell whether
he lives: by the number of the process on the same machine; by the lock, which the system lets go of however the
process ends; and where neither reaches, as on a disk of several machines, by the time, which the owner renews.

The claim of a dead owner is taken over by whoever creates the file of its one successor, ``.NAME.HASH.claim.DIGEST``,
named after what stands in it: that is moved to its place. So of several processes that find it, one gets it.
"""

import contextlib
import errno
import hashlib
import json
import os
import re
import secrets
import threading
import time
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Self

from . import parts
from .cores import granted_threads
from .errors import RefusalError
from .owners import FLAGS, boot, numbering, runs, short, start_of, try_lock
from .writing import printable

# Seconds from one sign of life to the next, and for how long there may be none. Both by the clock of the file server.
BEAT = 30.0
SILENCE = 300.0
_LONGEST = 40
_LONGEST_TEXT = 2000
_TRIES = 100
_PAUSE = 0.01
_GONE = (errno.ENOENT, errno.ESTALE)


@dataclass(frozen=True)
class Owner:
    """A process that is at work on something.

    Attributes
    ----------
    host : str
        Name of its machine.
    pid : int
    since : str
        When it began, by its own clock.
    """

    host: str = "unknown"
    pid: int = 0
    since: str = "unknown"

    def __str__(self) -> str:
        return f"host {self.host}, pid {self.pid}, since {self.since}"


class Claim:
    """The right to work on an output: a context manager, unless somebody else has it.

    Parameters
    ----------
    target : Path
        The output. Of a link, what it leads to.

    Attributes
    ----------
    owner : Owner or None
        Who has it; None if it is ours, until it is released.

    Raises
    ------
    OSError
        If the folder takes no new file.
    """

    def __init__(self, target: Path) -> None:
        self.owner: Owner | None = None
        self._target = Path(os.path.realpath(target))
        self._path = _place_of(target)
        self._descriptor = -1
        taken = _take(self._path)
        if isinstance(taken, Owner):
            self.owner = taken
            return
        self._descriptor = taken
        self._released = threading.Event()
        _start_beating(taken, self._released)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def remove_parts(self) -> None:
        """Remove parts of the output that others left behind, on whatever machine: nobody else works on it."""
        with contextlib.suppress(OSError):
            os.utime(self._descriptor)
            parts.remove_dead([self._target], before=os.fstat(self._descriptor).st_mtime - SILENCE)

    def release(self) -> None:
        """Let others have it; harmless when repeated, also by a signal handler in the midst of it."""
        if self._descriptor < 0:
            return
        _remove(self._path, self._descriptor)
        descriptor, self._descriptor = self._descriptor, -1
        os.close(descriptor)
        self._released.set()


def owner_of(target: Path) -> Owner | None:
    """Who is at work on an output; None if nobody is.

    Parameters
    ----------
    target : Path

    Raises
    ------
    OSError
        If the folder cannot be read.
    """
    found = _look(_place_of(target))
    return found.owner if found is not None and found.lives else None


def remove_dead(targets: Iterable[Path]) -> None:
    """Remove claims that processes on these outputs left behind when they were killed.

    Parameters
    ----------
    targets : iterable of Path
    """
    homes: dict[Path, set[str]] = {}
    for target in targets:
        place = _place_of(target)
        homes.setdefault(place.parent, set()).add(place.name)
    for home, names in homes.items():
        with contextlib.suppress(OSError):
            for entry in list(os.scandir(home)):
                match = _CLAIM.fullmatch(entry.name)
                if match and match[1] in names:
                    taken = _take(Path(entry.path))
                    if not isinstance(taken, Owner):
                        _drop(Path(entry.path), taken)


# With successors that died as they took over.
_CLAIM = re.compile(r"(.*\.claim)(\.[0-9a-f]{8})*", re.DOTALL)


@dataclass(frozen=True)
class _Found:
    digest: str
    owner: Owner
    lives: bool


def _place_of(target: Path) -> Path:
    real = Path(os.path.realpath(target))
    # Names are limited, and those that are cut shall still differ.
    return real.with_name(f".{real.name[:_LONGEST]}.{short(real.name)}.claim")


def _take(path: Path) -> int | Owner:
    """Create a claim, or take over that of a dead owner: its descriptor, or the living owner."""
    for _ in range(_TRIES):
        with contextlib.suppress(FileExistsError):
            return _make(path)
        found = _look(path)
        if found is None:
            continue
        if found.lives:
            return found.owner
        successor = path.with_name(f"{path.name}.{found.digest}")
        taken = _take(successor)
        if isinstance(taken, Owner):
            return taken
        try:
            # Another successor may have come and gone since we looked. From here on there is none but us.
            again = _look(path)
            if again is not None and again.digest == found.digest and not again.lives:
                os.replace(successor, path)
                return taken
        except BaseException:
            _drop(successor, taken)
            raise
        _drop(successor, taken)
    raise OSError(errno.EBUSY, f"{path.name} is never the same for long")


def _make(path: Path) -> int:
    descriptor = os.open(path, FLAGS | os.O_CREAT | os.O_EXCL, 0o666)
    try:
        record = {
            "host": os.uname().nodename,
            "pid": os.getpid(),
            "since": datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S UTC"),
            "boot": boot(),
            "numbering": numbering(),
            "started": start_of(os.getpid()),
            "locked": _lock(descriptor),
            "token": secrets.token_hex(8),
        }
        os.write(descriptor, json.dumps(record).encode())
        # Or other machines would not see it before it is closed.
        os.fsync(descriptor)
    except BaseException:
        _drop(path, descriptor)
        raise
    return descriptor


def _lock(descriptor: int) -> bool:
    """Lock what somebody may be looking at for a moment; False where that is not to be had."""
    for _ in range(_TRIES):
        locked = try_lock(descriptor)
        if locked is not False:
            return locked is True
        time.sleep(_PAUSE)
    return False


def _look(path: Path) -> _Found | None:
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK)
        try:
            free = try_lock(descriptor, shared=True)
            text = os.read(descriptor, _LONGEST_TEXT)
            changed = os.fstat(descriptor).st_mtime
        finally:
            os.close(descriptor)
    except OSError as error:
        if error.errno in _GONE:
            return None
        raise
    record = _parsed(text)
    owner = Owner(printable(record["host"], 64), record["pid"], printable(record["since"], 64)) if record else Owner()
    return _Found(hashlib.sha256(text).hexdigest()[:8], owner, _lives(record, free, changed, path.parent))


def _parsed(text: bytes) -> dict[str, Any]:
    """What a claim says; nothing if it was just created, or is none of ours."""
    try:
        record = json.loads(text)
        kinds = {"host": str, "pid": int, "since": str, "boot": str, "numbering": str, "started": str, "locked": bool}
        return record if all(type(record[name]) is kind for name, kind in kinds.items()) else {}
    except (ValueError, LookupError, TypeError, RecursionError):
        return {}


def _lives(record: dict[str, Any], free: bool | None, changed: float, home: Path) -> bool:
    if free is False:
        return True
    if record and record["boot"] == boot():
        if record["host"] == os.uname().nodename and record["numbering"] == numbering():
            living = runs(record["pid"], record["started"])
            if not living or record["started"]:
                return living
        if free and record["locked"]:
            return False
    # A lock may not reach from one machine to another. A clock that was set back is no sign of life either.
    now = _server_time(home)
    return now is None or abs(now - changed) < SILENCE


def _server_time(home: Path) -> float | None:
    """Time of the machine that keeps the files of a folder; None if it takes none."""
    import tempfile

    with contextlib.suppress(OSError), tempfile.TemporaryFile(dir=home) as probe:
        os.utime(probe.fileno())
        return os.fstat(probe.fileno()).st_mtime
    return None


def _start_beating(descriptor: int, released: threading.Event) -> None:
    # The work comes first. Where there is no thread to spare, other machines take its owner for dead after a while.
    with contextlib.suppress(RefusalError):
        if granted_threads(2) == 2:
            own = os.dup(descriptor)
            try:
                threading.Thread(target=_beat, args=(own, released), daemon=True).start()
            except RuntimeError:
                os.close(own)


def _beat(descriptor: int, released: threading.Event) -> None:
    """Give a sign of life now and then, by the clock of the file server."""
    while not released.wait(BEAT):
        with contextlib.suppress(OSError):
            os.utime(descriptor)
    os.close(descriptor)


def _remove(path: Path, descriptor: int) -> None:
    # Somebody may have taken us for dead, if we were suspended for long.
    with contextlib.suppress(OSError):
        if os.path.samestat(os.fstat(descriptor), os.stat(path, follow_symlinks=False)):
            os.unlink(path)


def _drop(path: Path, descriptor: int) -> None:
    _remove(path, descriptor)
    os.close(descriptor)
