"""Compiled code as plain Python, in a process of its own, so that every draw can be written down.

Whoever imports this module has no compiled goniosim any more.
"""

import sys
import types
from pathlib import Path

import numpy as np

import goniosim

_FOLDER = Path(goniosim.__file__).parent

_INTRINSICS = {
    "bits_to_float": lambda bits: np.uint64(bits).view(np.float64),
    "float_to_bits": lambda number: np.float64(number).view(np.uint64),
    "fma": lambda x, y, z: np.float64(np.longdouble(x) * y + z),
}


def _as_it_is(function):
    return function


def _intrinsic(function):
    # Others move energy into cells, which no draw depends on.
    return _INTRINSICS.get(function.__name__, lambda *_: None)


def _replace():
    from llvmlite import ir
    from numba import types as numba_types

    jit = types.ModuleType("goniosim._jit")
    jit.__path__ = [str(_FOLDER / "_jit")]
    jit.scalar = jit.stage = jit.kernel = _as_it_is
    jit.intrinsic, jit.ir, jit.types = _intrinsic, ir, numba_types
    jit.CACHE_FOLDER = None
    target = types.ModuleType("goniosim._jit.target")
    # No vector extensions.
    target.target = lambda: ("", [])
    sys.modules["goniosim._jit"], sys.modules["goniosim._jit.target"] = jit, target


_replace()
# As compiled code has it.
np.seterr(all="ignore")

from goniosim.optics import random as _random  # noqa: E402

# What was drawn: key, counter, and the line of the file that asked for it.
DRAWN = []


def _written_down(draw):
    def recorder(key, counter):
        frame = sys._getframe(1)
        place = f"{Path(frame.f_code.co_filename).relative_to(_FOLDER)}:{frame.f_lineno}"
        DRAWN.append((int(key), int(counter), place))
        return draw(key, counter)

    return recorder


_random.uniform = _written_down(_random.uniform)
_random.random_sincos = _written_down(_random.random_sincos)
