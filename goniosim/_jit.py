"""The three decorators under which all compiled code is written, and where the compiled code is kept.

``scalar``
    Pure functions of numbers. They are inlined into the loops that call them, so that
    the loops stay straight-line code that LLVM turns into SIMD instructions.
``stage``
    Functions over arrays, called by kernels and merged into them. A call that stays a call is
    resolved by name, and may find a copy that was compiled along with another caller; where the
    order of a sum is the compiler's to choose, copies differ in the last bit, and a first run would
    not equal a later one that takes its kernels from the cache.
``kernel``
    Functions over arrays, called from Python. They release the GIL and are cached on disk.

Numba's cache looks only at the file that holds a function, not at the functions inlined into
it. The cache folder is therefore named after a hash of every source file that may contain
compiled code: an edit anywhere means a new folder, never stale machine code.
"""

import hashlib
import os
import platform
import tempfile
from pathlib import Path

import numba
from numba import njit

# Which liberties the compiler may take with floating point:
#   contract  fused multiply-add
#   reassoc   sums in any order: without it no reduction becomes SIMD code
#   nsz       the sign of zero does not matter
#   arcp      x / y may become x * (1 / y)
# Deliberately absent: nnan and ninf. They would let the compiler delete the selects that
# discard the NaN or Inf of a branch not taken (total internal reflection, grazing rays).
FASTMATH = {"contract", "reassoc", "nsz", "arcp"}

_PACKAGE = Path(__file__).resolve().parent
_COMPILED = ("optics", "slices", "integration", "engine", "models")


def source_hash():
    """Hash of all sources that may hold compiled code, of numba's version and of its setting."""
    digest = hashlib.sha256(f"{numba.__version__} {platform.python_version()}".encode())
    for folder in _COMPILED:
        for path in sorted((_PACKAGE / folder).rglob("*.py")):
            digest.update(str(path.relative_to(_PACKAGE)).encode())
            digest.update(path.read_bytes())
    digest.update(Path(__file__).read_bytes())
    return digest.hexdigest()[:16]


def _writable_folder(candidates):
    for folder in candidates:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                return folder
        except OSError:
            continue
    return None


def _cache_folder():
    """First writable of: $NUMBA_CACHE_DIR, $XDG_CACHE_HOME or ~/.cache, the system's temporary folder."""
    name = source_hash()
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    user = os.getuid() if hasattr(os, "getuid") else "user"
    parents = [os.environ.get("NUMBA_CACHE_DIR"), home, os.path.join(tempfile.gettempdir(), f"cache-{user}")]
    return _writable_folder([Path(parent) / "goniosim" / name for parent in parents if parent])


CACHE_FOLDER = _cache_folder()


def scalar(function):
    """Compile a pure function of numbers, to be inlined into its callers."""
    return njit(inline="always", error_model="numpy", fastmath=FASTMATH)(function)


def stage(function):
    """Compile a function over arrays, to be merged into the kernels that call it."""
    return njit(forceinline=True, nogil=True, error_model="numpy", fastmath=FASTMATH)(function)


def kernel(function):
    """Compile a function over arrays; cached on disk, releases the GIL."""
    # The folder is looked up while the decorator runs: other users of numba keep theirs.
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(CACHE_FOLDER)
    try:
        # error_model="numpy": the check for division by zero of the default blocks SIMD.
        return njit(cache=CACHE_FOLDER is not None, nogil=True, error_model="numpy", fastmath=FASTMATH)(function)
    finally:
        numba.config.CACHE_DIR = before
