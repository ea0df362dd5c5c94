"""From a path to an open file that is what goniosim wrote, or a clear line on why it is not."""

import contextlib
import errno
import io
import stat
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import h5py

from goniosim.errors import (
    AnnotatedFileWarning,
    DamagedFileError,
    ForeignFileError,
    GoniosimError,
    NewerSchemaError,
    UnreadableFileError,
    UnusableResultError,
)
from goniosim.store import access, checksums, legacy, seal
from goniosim.store.kinds import KINDS, MODELS, PORTION, RESULT, Kind
from goniosim.store.manifest import Manifest, NoManifest
from goniosim.writing import StrPath, printable

SIGNATURE = b"\x89HDF\r\n\x1a\n"
# Where the superblock of HDF5 (version 2 and 3) says how long the file is.
_END_AT = slice(28, 36)
# At such a path there is no file.
_NOWHERE = (None, errno.ELOOP, errno.ENAMETOOLONG, errno.ENOTDIR)
# What the system says to whoever follows a damaged offset, unlike all else.
_MISLED = (errno.EINVAL, errno.EOVERFLOW)


def open_regular(path: StrPath) -> io.BufferedReader:
    """Open a file for reading, or explain why it cannot be one of ours.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    io.BufferedReader

    Raises
    ------
    ForeignFileError
        If the file is missing or not a regular file; an UnreadableFileError if the system refuses it.
    """
    try:
        mode = Path(path).stat().st_mode
        if stat.S_ISDIR(mode):
            raise ForeignFileError(f"{path}: is a folder, not a goniosim result; name a file in it")
        # Opening a named pipe would wait for a writer for ever.
        if not stat.S_ISREG(mode):
            raise ForeignFileError(f"{path}: is not a regular file; copy the data into a file first")
        return open(path, "rb")
    except FileNotFoundError:
        raise ForeignFileError(f"{path}: no such file; check the path") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        foreign = ForeignFileError if getattr(error, "errno", None) in _NOWHERE else UnreadableFileError
        raise foreign(f"{path}: cannot be opened: {reason}; check the path and the permissions") from error


@contextlib.contextmanager
def decoding(path: StrPath, remedy: str) -> Iterator[None]:
    """Call whatever HDF5, h5py or the checks of this package trip over damage of the file ``path``.

    Parameters
    ----------
    path : path-like
    remedy : str
        What the user can do about it.

    Raises
    ------
    DamagedFileError
    UnreadableFileError
        It is the disk that fails: another attempt may find the file sound.
    """
    try:
        yield
    except (OSError, RuntimeError, LookupError, TypeError, ValueError, ArithmeticError, MemoryError) as error:
        if isinstance(error, OSError) and error.errno and error.errno not in _MISLED:
            raise UnreadableFileError(
                f"{path}: cannot be read: {error.strerror}; check the disk and the connection to it, and try again"
            ) from error
        reason = printable(" ".join(str(error).split()) or type(error).__name__)
        raise DamagedFileError(f"{path}: is damaged, or goniosim did not write it so: {reason}; {remedy}") from error


@contextlib.contextmanager
def opened(path: StrPath, kind: Kind, *, whole: bool = True) -> Iterator[tuple[h5py.File, Manifest | NoManifest]]:
    """Open a file of ours, for a ``with`` statement.

    All bytes are held against the digest in the seal before HDF5 sees any. If they differ, everything that was
    written is held against its own digest: the rest was added.

    Parameters
    ----------
    path : path-like
    kind : Kind
        What it has to be.
    whole : bool
        False if only the attributes of the root are wanted: they alone are verified.

    Yields
    ------
    file : h5py.File
    manifest : Manifest or NoManifest
        What in the file is ours.

    Raises
    ------
    ForeignFileError, DamagedFileError, NewerSchemaError, UnusableResultError
    """
    with open_regular(path) as stream, contextlib.ExitStack() as stack:
        # What goes wrong in the body of the ``with`` statement is no damage of the file.
        with decoding(path, kind.remedy):
            # Reading through this very stream leaves no moment in which another file could take its place, and
            # needs no file locks, which some network file systems lack.
            ours = _verified(stream, path, kind, whole, stack)
        yield ours.file, ours


def _verified(
    stream: io.BufferedReader, path: StrPath, kind: Kind, whole: bool, stack: contextlib.ExitStack
) -> Manifest | NoManifest:
    head = stream.read(seal.WINDOW)
    if kind is RESULT and head.startswith(legacy.MARK):
        _refuse_newer(head, 0, path, kind)
        return _earlier(stream, path, kind, whole, stack)
    place = seal.find(head, kind.mark)
    if place >= 0 and head.startswith(SIGNATURE):
        _refuse_newer(head, place, path, kind)
    intact = whole and _is_intact(stream, head, place)
    if not intact:
        found, readable = _kind(stream, head)
        if found is not kind:
            raise _another(found, head, path, kind)
        if place < 0 and kind is MODELS and readable and _is_earlier(stream, path):
            return _earlier(stream, path, kind, whole, stack)
    sealed = _sealed(stream, head, place, path, kind)
    manifest = Manifest(_hdf5(stream, stack), sealed.content_digest)
    manifest.hold_root()
    if whole and not intact:
        manifest.hold_all()
        warnings.warn(
            f"{path}: annotated: something was added after it was written; what goniosim wrote is unchanged",
            AnnotatedFileWarning,
            stacklevel=6,
        )
    return manifest


def _hdf5(stream: io.BufferedReader, stack: contextlib.ExitStack) -> h5py.File:
    file = h5py.File(stream, "r")

    def close() -> None:
        # HDF5 may stumble over damage once more; by now all that was wanted is read.
        with contextlib.suppress(OSError, RuntimeError):
            file.close()

    stack.callback(close)
    return file


def _is_intact(stream: BinaryIO, head: bytes, place: int) -> bool:
    """Whether a file is exactly what was written: found out before HDF5 sees any of it."""
    found = seal.parse(head, place) if place >= 0 and head.startswith(SIGNATURE) else None
    return found is not None and seal.digest(stream, place) == found.digest


def _is_earlier(stream: BinaryIO, path: StrPath) -> bool:
    """Whether a file of models without a seal is of a schema that had none."""
    with h5py.File(stream, "r") as file:
        version = access.text(file, "schema_version")
    if int(version.split(".")[0]) > int(MODELS.schema_version.split(".")[0]):
        raise _newer(version, path, MODELS)
    return version in ("1.0", "1.1")


def _earlier(
    stream: io.BufferedReader, path: StrPath, kind: Kind, whole: bool, stack: contextlib.ExitStack
) -> NoManifest:
    """Open a file of an earlier schema. Models had no digest, and only the checksums of HDF5."""
    digest, of_attributes = legacy.read(stream, path) if kind is RESULT else ("", "")
    if digest and whole:
        legacy.verify(stream, digest, path)
    file = _hdf5(stream, stack)
    if kind is MODELS:
        checksums.verify_all(file)
    if digest and not whole:
        legacy.verify_attributes({name: access.attribute(file, name) for name in file.attrs}, of_attributes, path)
    return NoManifest(file)


@contextlib.contextmanager
def written_by(version: str, path: StrPath, kind: Kind) -> Iterator[None]:
    """While active, what cannot be understood in a sound file of a newer minor schema is called newer, not damaged.

    Parameters
    ----------
    version : str
        Schema of the file, MAJOR.MINOR.
    path : path-like
    kind : Kind

    Raises
    ------
    NewerSchemaError
    """
    try:
        yield
    except ValueError as error:
        if _number(version) > _number(kind.schema_version):
            raise _newer(version, path, kind) from error
        raise


def _number(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))


def kind_of(path: StrPath) -> tuple[Kind | None, bool]:
    """Which kind a file is, sound or not, by its start alone.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    kind : Kind or None
        None for anything else, and for what cannot be read.
    readable : bool
        Whether HDF5 agrees; otherwise the file is damaged.
    """
    try:
        with open_regular(path) as stream:
            return _kind(stream, stream.read(seal.WINDOW))
    except (ForeignFileError, OSError):
        return None, False


def is_unreadable(path: StrPath) -> bool:
    """Whether a file is there, but the system does not let it be read."""
    try:
        with open_regular(path) as stream:
            stream.read(1)
    except (UnreadableFileError, OSError):
        return True
    except ForeignFileError:
        pass
    return False


def _kind(stream: BinaryIO, head: bytes) -> tuple[Kind | None, bool]:
    if head.startswith(legacy.MARK):
        return RESULT, True
    if head.startswith(SIGNATURE):
        try:
            with h5py.File(stream, "r") as file:
                if not access.has_attribute(file, "filetype"):
                    return None, True
                filetype = access.attribute(file, "filetype")
                return next((kind for kind in KINDS if kind.filetype == filetype), None), True
        except (OSError, RuntimeError, LookupError, TypeError, ValueError, MemoryError):
            pass
        named = (kind for kind in KINDS if kind.mark in head or kind.filetype.encode() in head)
    else:
        # Other files may well speak of ours; a whole seal is in none of them by accident.
        named = (kind for kind in KINDS if kind.mark in head and seal.parse(head, seal.find(head, kind.mark)))
    return next(named, None), False


def _refuse_newer(head: bytes, place: int, path: StrPath, kind: Kind) -> None:
    """The version comes before anything else: a newer file may differ in all the rest."""
    version = seal.version(head, place)
    if version is not None and version[0] > int(kind.schema_version.split(".")[0]):
        raise _newer(f"{version[0]}.{version[1]}", path, kind)


def _newer(version: str, path: StrPath, kind: Kind) -> NewerSchemaError:
    return NewerSchemaError(
        f"{path}: is {kind.what} of schema {version}, "
        f"but this goniosim reads schema {kind.schema_version}; update goniosim"
    )


def _another(found: Kind | None, head: bytes, path: StrPath, kind: Kind) -> GoniosimError:
    if not head:
        return ForeignFileError(f"{path}: is empty, and not {kind.what}; {kind.writer}")
    if kind is RESULT and found is MODELS:
        return UnusableResultError(
            f"{path}: holds integrated models and no simulation; {RESULT.writer} "
            "(`goniosim info`, `goniosim plot` and goniosim.store.open_models take this one)"
        )
    if kind is RESULT and found is PORTION:
        return UnusableResultError(
            f"{path}: holds a portion of a simulation; join it with the others by `goniosim merge` on their folder"
        )
    if kind is RESULT and legacy.MARK.startswith(head):
        return DamagedFileError(f"{path}: is cut off after {len(head)} bytes; {kind.remedy}")
    hdf5 = "an HDF5 file, but " if head.startswith(SIGNATURE) else ""
    return ForeignFileError(f"{path}: is {hdf5}not {kind.what}; {kind.writer}")


def _sealed(stream: BinaryIO, head: bytes, place: int, path: StrPath, kind: Kind) -> seal.Seal:
    """The seal at a place, if it is sound and the file not cut off."""
    if place < 0:
        raise DamagedFileError(f"{path}: its seal (the dataset checksums/file) is missing; {kind.remedy}")
    size = stream.seek(0, 2)
    found = seal.parse(head, place)
    if found is None:
        cut = size < place + seal.SIZE
        what = f"is cut off after {size} bytes" if cut else "its seal (the dataset checksums/file) is damaged"
        raise DamagedFileError(f"{path}: {what}; {kind.remedy}")
    # After an addition the file may be longer than it was written; HDF5 knows.
    if size < found.length and size < int.from_bytes(head[_END_AT], "little"):
        raise DamagedFileError(f"{path}: is cut off: {size} of {found.length} bytes; {kind.remedy}")
    return found
