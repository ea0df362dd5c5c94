"""Hidden files and folders in the making, ``.NAME.OWNER.part``: whose they are, and whether that run still lives.

A run holds a lock on its part for as long as it lives; the system lets go of it however the run ends. Where the file
system has no locks, the name tells which process of which machine it was.
"""

import contextlib
import math
import os
import re
import secrets
import shutil
from collections.abc import Iterable, Iterator
from pathlib import Path

from .owners import FLAGS, boot, host, runs, try_lock

# Of a folder, the file in it that is locked.
_LOCK = ".lock"
_LONGEST = 40
_PART = re.compile(r"\.(.*)\.([0-9a-f]{8})-([0-9a-f]{8})-(\d+)-[0-9a-f]{8}\.part", re.DOTALL)
_TRIES = 20


class Part:
    """A file or folder in the making, beside what it will become.

    Its name is hidden and without the usual ending, so that nobody takes it for the finished file; cut, since names
    are limited.

    Parameters
    ----------
    target : Path
        What it will become.
    folder : bool
        Whether it is a folder.
    inside : bool
        Whether it lies in the target, which is a folder then, instead of beside it.

    Attributes
    ----------
    path : Path
        To write to. A file exists from the start, and must be written without being replaced.
    descriptor : int
        Of the file, or of a lock in the folder.

    Raises
    ------
    OSError
        If the folder takes no new file.
    """

    def __init__(self, target: Path, *, folder: bool = False, inside: bool = False) -> None:
        self._folder = folder
        home = target if inside else target.parent
        for _ in range(_TRIES):
            owner = f"{host()}-{boot()}-{os.getpid()}-{secrets.token_hex(4)}"
            self.path = home / f".{target.name[:_LONGEST]}.{owner}.part"
            if folder:
                self.path.mkdir()
            self.descriptor = os.open(_lock_of(self.path, folder), FLAGS | os.O_CREAT | os.O_EXCL, 0o666)
            # Between the two calls another run may have taken it for an orphan.
            if try_lock(self.descriptor) is not False and self._is_there():
                return
            os.close(self.descriptor)
        raise OSError(f"{home}: every new file in it disappears")

    def _is_there(self) -> bool:
        try:
            return os.path.samestat(os.fstat(self.descriptor), os.stat(_lock_of(self.path, self._folder)))
        except FileNotFoundError:
            return False

    def move(self, target: Path) -> None:
        """Put it in place: of an earlier file, or where there is no folder or an empty one.

        Parameters
        ----------
        target : Path

        Raises
        ------
        OSError
            It is then still a part.
        """
        os.replace(self.path, target)
        if self._folder:
            with contextlib.suppress(OSError):
                os.unlink(target / _LOCK)
        os.close(self.descriptor)
        self.descriptor = -1

    def remove(self) -> None:
        """Remove it, unless it was moved; harmless when repeated."""
        if self.descriptor >= 0:
            _remove(self.path, self._folder)
            os.close(self.descriptor)
            self.descriptor = -1


def remove_dead(targets: Iterable[Path], *, inside: bool = False, before: float | None = None) -> None:
    """Remove parts that runs on these outputs left behind when they were killed.

    Those of a living run are kept, and those of another machine of which nobody here can tell, unless they are old.

    Parameters
    ----------
    targets : iterable of Path
        Files or folders that such parts would have become.
    inside : bool
        Look in the targets, which are folders, instead of beside them.
    before : float, optional
        When those of other machines have to have changed last, to be old: for whoever has claimed these outputs, by
        the clock of the machine that keeps them.
    """
    homes: dict[Path, set[str]] = {}
    for target in targets:
        homes.setdefault(target if inside else target.parent, set()).add(target.name[:_LONGEST])
    for home, names in homes.items():
        with contextlib.suppress(OSError):
            for entry in list(os.scandir(home)):
                match = _PART.fullmatch(entry.name)
                if match and match[1] in names:
                    # A name that may have been cut may be that of another output.
                    old = before is not None and len(match[1]) < _LONGEST and _changed(entry) < before
                    folder = entry.is_dir(follow_symlinks=False)
                    _remove_if_dead(Path(entry.path), folder, *match.groups()[1:], old=old)


@contextlib.contextmanager
def turn(folder: Path, patience: float = 2.0) -> Iterator[None]:
    """Let one run after the other put files into a folder.

    Parameters
    ----------
    folder : Path
    patience : float
        Seconds to wait. Somebody may hold a lock on the folder for reasons of his own, and some file systems have
        none: a file then appears whole all the same.
    """
    import time

    descriptor = -1
    try:
        with contextlib.suppress(OSError):
            descriptor = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
            last = time.monotonic() + patience
            while try_lock(descriptor) is False and time.monotonic() < last:
                time.sleep(0.01)
        yield
    finally:
        if descriptor >= 0:
            os.close(descriptor)


def _changed(entry: os.DirEntry[str]) -> float:
    try:
        return entry.stat(follow_symlinks=False).st_mtime
    except FileNotFoundError:
        return math.inf


def _remove_if_dead(path: Path, folder: bool, on: str, since: str, pid: str, *, old: bool) -> None:
    here, since_boot = on == host(), since == boot()
    # A lock may not reach from one machine to another.
    if not (here or since_boot):
        if old:
            _remove(path, folder)
        return
    free = None
    descriptor = -1
    try:
        with contextlib.suppress(OSError):
            descriptor = os.open(_lock_of(path, folder), FLAGS)
            free = try_lock(descriptor)
        dead = free or (free is None and here and not (since_boot and runs(int(pid))))
        if dead:
            _remove(path, folder)
    finally:
        if descriptor >= 0:
            os.close(descriptor)


def _remove(path: Path, folder: bool) -> None:
    if folder:
        # A process that helps may put a last file into it meanwhile.
        for _ in range(_TRIES):
            shutil.rmtree(path, ignore_errors=True)
            if not path.exists():
                break
    else:
        with contextlib.suppress(OSError):
            os.unlink(path)


def _lock_of(path: Path, folder: bool) -> Path:
    return path / _LOCK if folder else path
