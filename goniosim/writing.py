"""Putting files into place, whole or not at all, and saying why when that fails."""

import contextlib
import errno
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from .errors import OutputError
from .parts import Part, remove_dead

StrPath = str | os.PathLike[str]

NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
_REMEDIES = {
    **dict.fromkeys(NO_ROOM, "free some space, raise the quota or the limit on file sizes, or choose another place"),
    errno.ENAMETOOLONG: "choose a shorter name",
    errno.ELOOP: "mend the links, which lead in a circle, or choose another place",
    errno.ENOTDIR: "choose another place: what stands before the last / must be a folder",
    errno.EISDIR: "choose another name: a folder is called so",
    errno.EEXIST: "choose another place: something that is no folder is called so",
    errno.ENOENT: "check that the folder is there, or choose another place",
    errno.EMFILE: "raise the limit on open files (ulimit -n)",
    errno.ENFILE: "close other programs: too many files are open in the whole system",
    errno.EAGAIN: "raise the limit on processes and threads (ulimit -u), or use fewer threads",
    errno.ENOMEM: "free some memory, raise the limit on it, or use fewer threads",
}


def printable(text: object, most: int = 0) -> str:
    r"""Text as one line that a terminal shows and does not obey.

    Parameters
    ----------
    text : object
        From a file or a file name, which may hold escape sequences and line breaks.
    most : int
        Cut after so many characters; 0 for no limit.

    Returns
    -------
    str
        Characters that cannot be printed are written as in Python: ``\x1b``.
    """
    shown = str(text)
    cut = f"{shown[:most]}..." if 0 < most < len(shown) else shown
    return "".join(each if each.isprintable() else each.encode("unicode_escape").decode() for each in cut)


def make_folder(folder: StrPath) -> None:
    """Create a folder and those above it.

    Parameters
    ----------
    folder : path-like

    Raises
    ------
    OutputError
    """
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: the folder cannot be created: {reason(error)}; {remedy(error)}") from error


def remedy(error: OSError) -> str:
    """What to do about an error of the operating system."""
    return _REMEDIES.get(error.errno or 0, "check the permissions, or choose another place")


def reason(error: OSError) -> str:
    """What the operating system says, in one line."""
    # The errors of HDF5 have a text, but no number.
    return error.strerror or " ".join(str(error).split())


@contextlib.contextmanager
def explained(path: StrPath) -> Iterator[None]:
    """Turn what the operating system says about writing ``path`` into an `OutputError` of one line."""
    try:
        yield
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {reason(error)}; {remedy(error)}") from error


def refuse_to_replace(path: StrPath) -> None:
    """Make sure that nothing but a file would be replaced, and none that is read-only.

    A finished file takes the name of the one before it, whatever that is: the system would not object.

    Parameters
    ----------
    path : path-like

    Raises
    ------
    OutputError
        A folder, a device, a pipe or a socket stands there, or a file that nobody may write to.
    """
    with explained(path):
        try:
            mode = os.stat(path).st_mode
        except (FileNotFoundError, NotADirectoryError):
            return
        if stat.S_ISDIR(mode):
            raise OSError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not stat.S_ISREG(mode):
        raise OutputError(f"{path}: exists and is not a regular file, so it is not replaced; choose another name")
    # Of root the system says that he may write to it.
    if not mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH):
        raise OutputError(f"{path}: exists and is read-only, so it is not overwritten; choose another name or chmod +w")


class Replacement:
    """A file in the making, beside the one that it will replace.

    Parameters
    ----------
    path : path-like
        A link stays a link: the file it names is the one to replace.

    Attributes
    ----------
    temporary : Path
        Where to write: an empty file, which must not itself be replaced.

    Raises
    ------
    OutputError
        The folder takes no new file, or what stands there must stay.
    """

    def __init__(self, path: StrPath) -> None:
        self._path = path
        refuse_to_replace(path)
        self._target = Path(os.path.realpath(path))
        remove_dead([self._target])
        with explained(path):
            self._part = Part(self._target)
        self.temporary = self._part.path

    def commit(self) -> None:
        """Put the finished file in place: readers see the old file or the new one, never a mixture."""
        # Meanwhile something else may stand there.
        refuse_to_replace(self._path)
        with explained(self._path):
            self._part.move(self._target)

    def discard(self) -> None:
        """Remove what was written, unless it was committed."""
        self._part.remove()


@contextlib.contextmanager
def replacing(path: StrPath) -> Iterator[Path]:
    """Write a file under another name, which becomes ``path`` if all goes well.

    Parameters
    ----------
    path : path-like

    Yields
    ------
    Path
        Where to write.

    Raises
    ------
    OutputError
        The file cannot be written; an earlier one is then as it was.
    """
    replacement = Replacement(path)
    try:
        with explained(path):
            yield replacement.temporary
        replacement.commit()
    finally:
        replacement.discard()


def write_text(path: StrPath, text: str) -> None:
    """Write a text file, whole or not at all.

    Parameters
    ----------
    path : path-like
    text : str

    Raises
    ------
    OutputError
    """
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
