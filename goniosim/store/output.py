"""Getting bytes onto the disk: a place reserved before the computation, an atomic write after it."""

import contextlib
import errno
import os
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Self

from goniosim.errors import OutputError
from goniosim.parts import Part, remove_dead, turn
from goniosim.store.kinds import RESULT, Kind
from goniosim.store.opening import is_unreadable, kind_of
from goniosim.writing import NO_ROOM, StrPath, explained, refuse_to_replace, remedy

Buffer = bytes | memoryview


class Reservation:
    """Room for one output file: a temporary file beside it, of the predicted size.

    A context manager: whatever is not committed is removed on the way out.

    Parameters
    ----------
    target : Path
        Where the file will stand.
    shown : path-like
        What the user calls it.
    kind : goniosim.store.kinds.Kind
        Of the file; only one of its kind is replaced.

    Raises
    ------
    OSError
        If the folder takes no new file.
    """

    def __init__(self, target: Path, shown: StrPath, kind: Kind = RESULT) -> None:
        self._target = target
        self._kind = kind
        self._shown = shown
        self._part = Part(target)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def allocate(self, size_bytes: int) -> None:
        """Claim disk space.

        Parameters
        ----------
        size_bytes : int

        Raises
        ------
        OSError
            If there is not enough.
        """
        # Asked first: where a file system cannot allocate, the C library writes block after block instead.
        disk = os.fstatvfs(self._part.descriptor)
        if disk.f_blocks and disk.f_bavail * disk.f_frsize < size_bytes:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        try:
            os.posix_fallocate(self._part.descriptor, 0, max(1, size_bytes))
        except (AttributeError, OSError) as error:
            # Anything else means that this system or file system cannot allocate ahead.
            if getattr(error, "errno", None) in NO_ROOM:
                raise

    def commit(self, parts: Sequence[Buffer], check: Callable[[], None]) -> None:
        """Put the finished file in place: readers see the old file or the new one, never a mixture.

        Parameters
        ----------
        parts : sequence of bytes-like
            The content, one part after the other.
        check : callable
            Called when no other run replaces the target; raises an OutputError if what stands there must stay.

        Raises
        ------
        OutputError
            If the file cannot be written; the target is then as it was.
        """
        with explained(self._shown):
            _write(self._part.descriptor, parts)
        # Also what fails on the way to an answer on what stands there.
        with turn(self._target.parent), explained(self._shown):
            _refuse_to_destroy(self._target, self._shown, self._kind)
            check()
            self._part.move(self._target)
        # The name itself survives a power cut only after this. Some network file systems refuse it.
        with contextlib.suppress(OSError):
            folder = os.open(self._target.parent, os.O_RDONLY)
            try:
                os.fsync(folder)
            finally:
                os.close(folder)

    def release(self) -> None:
        """Close and remove the temporary file, if it is still there."""
        self._part.remove()


def reserve_output(path: StrPath, size_bytes: int, kind: Kind = RESULT) -> Reservation:
    """Make sure, before a long computation, that its result can be written.

    Parameters
    ----------
    path : path-like
        Output file. An earlier one of its kind may stand there, but nothing else.
    size_bytes : int
        Predicted size, see `predicted_size`. What killed runs on this output left behind makes room first;
        not for a size of 0, with which many places can be tried at little cost.
    kind : goniosim.store.kinds.Kind

    Returns
    -------
    Reservation
        To be handed to `write_result`, or released.

    Raises
    ------
    OutputError
        If the file could not be written: no folder, no permission, no room,
        or a file in the way that is not a goniosim result.
    """
    # A link stays a link: the file it names is the one to replace.
    target = Path(os.path.realpath(path))
    with explained(path):
        if target.is_symlink():
            raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
        _refuse_to_destroy(target, path, kind)
        if not target.parent.is_dir():
            what = "is not a folder" if target.parent.exists() else "does not exist"
            raise OutputError(f"{path}: the folder {target.parent} {what}; create it, or choose another place")
    if size_bytes:
        remove_dead([target])
    try:
        reservation = Reservation(target, path, kind)
    except OSError as error:
        raise OutputError(
            f"{path}: the folder {target.parent} takes no new file: {error.strerror}; {remedy(error)}"
        ) from error
    try:
        reservation.allocate(size_bytes)
    except OSError as error:
        reservation.release()
        raise OutputError(
            f"{path}: no room for about {size_bytes / 1e6:.1f} MB: {error.strerror}; {remedy(error)}"
        ) from error
    except BaseException:
        reservation.release()
        raise
    return reservation


def rescue(parts: Sequence[Buffer], path: StrPath) -> str:
    """Save finished work in the temporary directory.

    Parameters
    ----------
    parts : sequence of bytes-like
        Content of the file.
    path : path-like
        Where it should have gone.

    Returns
    -------
    str
        What to tell the user.
    """
    directory = tempfile.gettempdir()
    name = None
    try:
        descriptor, name = tempfile.mkstemp(prefix=Path(path).stem[:40] + "-", suffix=".h5", dir=directory)
        try:
            _write(descriptor, parts)
        finally:
            os.close(descriptor)
    except OSError as error:
        if name is not None:
            with contextlib.suppress(OSError):
                os.unlink(name)
        return f"nor could the result be saved in {directory}: {error.strerror}"
    return f"the result was saved as {name} instead"


def _refuse_to_destroy(target: Path, shown: StrPath, kind: Kind) -> None:
    if target.is_dir():
        raise OutputError(f"{shown}: is a folder; name a file in it, such as {Path(shown) / 'result.h5'}")
    if target.exists() and kind_of(target)[0] is not kind:
        if is_unreadable(target):
            raise OutputError(f"{shown}: exists and cannot be read, so it is not overwritten; choose another name")
        raise OutputError(
            f"{shown}: exists and is not {kind.what}, so it is not overwritten; choose another name or remove it"
        )
    refuse_to_replace(shown)


def _write(descriptor: int, parts: Sequence[Buffer]) -> None:
    """Write, cut to length and sync."""
    position = 0
    for part in parts:
        view = memoryview(part)
        while view:
            written = os.pwrite(descriptor, view, position)
            position += written
            view = view[written:]
    os.ftruncate(descriptor, position)
    os.fsync(descriptor)
