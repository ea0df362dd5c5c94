"""The three decorators under which all compiled code is written.

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

Loops that store run over slices of rows, from 0 on: an index that LLVM cannot see to be positive might count from the
end, and whether the loop runs as SIMD code then depends on where arrays lie in memory, and with it the last bits.
"""

# First, since it looks at what numba is going to read.
from .environment import intrinsic, ir, njit, types
from .files import keep
from .folder import CACHE_FOLDER

__all__ = ["CACHE_FOLDER", "FASTMATH", "intrinsic", "ir", "kernel", "scalar", "stage", "types"]

# Which liberties the compiler may take with floating point:
#   contract  fused multiply-add
#   reassoc   sums in any order: without it no reduction becomes SIMD code
#   nsz       the sign of zero does not matter
#   arcp      x / y may become x * (1 / y)
# Deliberately absent: nnan and ninf. They would let the compiler delete the selects that
# discard the NaN or Inf of a branch not taken (total internal reflection, grazing rays).
FASTMATH = {"contract", "reassoc", "nsz", "arcp"}


def scalar(function):
    """Compile a pure function of numbers, to be inlined into its callers."""
    return njit(inline="always", error_model="numpy", fastmath=FASTMATH)(function)


def stage(function):
    """Compile a function over arrays, to be merged into the kernels that call it."""
    return njit(forceinline=True, nogil=True, error_model="numpy", fastmath=FASTMATH)(function)


def kernel(function):
    """Compile a function over arrays; cached on disk, releases the GIL."""
    # error_model="numpy": the check for division by zero of the default blocks SIMD.
    compiled = njit(nogil=True, error_model="numpy", fastmath=FASTMATH)(function)
    if CACHE_FOLDER is not None:
        keep(compiled, CACHE_FOLDER)
    return compiled
