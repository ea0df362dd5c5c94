"""The files of compiled code: checked before they are believed, and never in the way.

Each starts with a checksum of its content. What is cut, empty, altered or no file at all counts as
absent, is removed, and is compiled and written anew. A file that cannot be written costs the next run
some seconds, and this one nothing.
"""

import contextlib
import hashlib
import os
import pickle
import shutil
import stat

from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile, UserProvidedCacheLocator

from .environment import config
from .folder import notices

_CHECKSUM = hashlib.sha256().digest_size


def keep(compiled, folder):
    """Give a compiled function a cache.

    Parameters
    ----------
    compiled : numba dispatcher
    folder : Path
        Ours alone, see `folder.private_folder`.
    """
    try:
        compiled._cache = KernelCache(compiled.py_func, folder)
    except (OSError, RuntimeError) as error:
        _note(error)


def _note(error):
    # Without the name of the kernel: one full disk is one line.
    line = f"compiled code is not kept: {getattr(error, 'strerror', None) or error}"
    if line not in notices:
        notices.append(line)


class _Locator(UserProvidedCacheLocator):
    """A folder for each package, in ours."""

    def ensure_cache_path(self):
        # Not the folders above it: they would not be checked.
        with contextlib.suppress(FileExistsError):
            os.mkdir(self.get_cache_path(), 0o700)


class _Implementation(CompileResultCacheImpl):
    _locator_classes = (_Locator,)


class KernelCache(FunctionCache):
    """Numba's cache of a function, in which nothing that fails is fatal.

    Parameters
    ----------
    function : Python function
    folder : Path
    """

    _impl_class = _Implementation

    def __init__(self, function, folder):
        # Numba looks at its settings meanwhile: other users of numba keep theirs.
        ours = {"CACHE_DIR": str(folder), "CACHE_LOCATOR_CLASSES": ""}
        before = {name: getattr(config, name, "") for name in ours}
        vars(config).update(ours)
        try:
            super().__init__(function)
        finally:
            vars(config).update(before)
        stamp = self._impl.locator.get_source_stamp()
        self._cache_file = _CheckedFiles(self.cache_path, self._impl.filename_base, stamp)

    def load_overload(self, sig, target_context):
        """Machine code for a signature, or None where there is none that can be used."""
        try:
            return super().load_overload(sig, target_context)
        except Exception:
            self._cache_file.forget()
            return None

    def save_overload(self, sig, data):
        """Write machine code, if it can be written."""
        try:
            super().save_overload(sig, data)
        except Exception as error:
            _note(error)


class _CheckedFiles(IndexDataCacheFile):
    """An index of signatures, and a file of machine code for each of them."""

    def load(self, key):
        """Find what was kept under a key, or None."""
        found = super().load(key)
        # Of two processes that write at the same time, one may have taken the other's number.
        return found[1] if found is not None and found[0] == key else None

    def save(self, key, data):
        """Keep machine code under a key."""
        super().save(key, (key, data))

    def forget(self):
        """Begin anew."""
        _remove(self._index_path)

    def _load_index(self):
        found = _read(self._index_path)
        return found[1] if found is not None and found[0] == self._source_stamp else {}

    def _save_index(self, overloads):
        self._write(self._index_path, (self._source_stamp, overloads))

    def _load_data(self, name):
        return _read(self._data_path(name))

    def _save_data(self, name, data):
        self._write(self._data_path(name), data)

    def _write(self, path, content):
        encoded = self._dump(content)
        if os.path.isdir(path):
            _remove(path)
        # Renamed into place, so that no other process sees half of it.
        with self._open_for_write(path) as stream:
            stream.write(hashlib.sha256(encoded).digest())
            stream.write(encoded)


def _read(path):
    """Content of a file; None if there is none, or none that is whole."""
    try:
        if not stat.S_ISREG(os.lstat(path).st_mode):
            raise OSError(f"{path} is not a file")
        with open(path, "rb") as stream:
            checksum, encoded = stream.read(_CHECKSUM), stream.read()
    except FileNotFoundError:
        return None
    except OSError:
        checksum, encoded = b"", b""
    if hashlib.sha256(encoded).digest() != checksum:
        _remove(path)
        return None
    return pickle.loads(encoded)


def _remove(path):
    try:
        os.unlink(path)
    except OSError:
        shutil.rmtree(path, ignore_errors=True)
