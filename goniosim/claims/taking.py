"""How a claim is taken: of several processes that want it, one gets it, also over a network file system.

It is a file that only one process can create. That of a dead owner is taken over by whoever creates the file of its
one successor, ``.NAME.HASH.claim.DIGEST``, named after what stands in it: that is moved to its place.
"""

import contextlib
import errno
import hashlib
import os
import time
from dataclasses import dataclass
from pathlib import Path

from ..owners import FLAGS, try_lock
from .life import lives
from .owner import Owner, describe, owner_in, parse

_LONGEST_TEXT = 2000
_TRIES = 100
_PAUSE = 0.01
_GONE = (errno.ENOENT, errno.ESTALE)


@dataclass(frozen=True)
class Found:
    """A claim that stands somewhere.

    Attributes
    ----------
    digest : str
        Of what it says.
    owner : Owner
    lives : bool
        Whether he does.
    """

    digest: str
    owner: Owner
    lives: bool


def take(path: Path) -> int | Owner:
    """Create a claim, or take over that of a dead owner: its descriptor, or the living owner."""
    for _ in range(_TRIES):
        with contextlib.suppress(FileExistsError):
            return _make(path)
        found = look(path)
        if found is None:
            continue
        if found.lives:
            return found.owner
        successor = path.with_name(f"{path.name}.{found.digest}")
        taken = take(successor)
        if isinstance(taken, Owner):
            return taken
        try:
            # Another successor may have come and gone since we looked. From here on there is none but us.
            again = look(path)
            if again is not None and again.digest == found.digest and not again.lives:
                os.replace(successor, path)
                return taken
        except BaseException:
            drop(successor, taken)
            raise
        drop(successor, taken)
    raise OSError(errno.EBUSY, f"{path.name} is never the same for long")


def look(path: Path) -> Found | None:
    """The claim at a path; None if there is none."""
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
    record = parse(text)
    return Found(hashlib.sha256(text).hexdigest()[:8], owner_in(record), lives(record, free, changed, path.parent))


def remove(path: Path, descriptor: int) -> None:
    """Remove a claim, if it is still the open one."""
    # Somebody may have taken us for dead, if we were suspended for long.
    with contextlib.suppress(OSError):
        if os.path.samestat(os.fstat(descriptor), os.stat(path, follow_symlinks=False)):
            os.unlink(path)


def drop(path: Path, descriptor: int) -> None:
    """Remove a claim and close it."""
    remove(path, descriptor)
    os.close(descriptor)


def _make(path: Path) -> int:
    descriptor = os.open(path, FLAGS | os.O_CREAT | os.O_EXCL, 0o666)
    try:
        os.write(descriptor, describe(_lock(descriptor)))
        # Or other machines would not see it before it is closed.
        os.fsync(descriptor)
    except BaseException:
        drop(path, descriptor)
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
