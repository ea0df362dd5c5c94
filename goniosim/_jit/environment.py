"""Numba, imported with an eye on the environment variables that it reads.

A value that it cannot use makes numba fail, or go on with a warning over a screenful of traceback. Here it is one line.
"""

import os
import re
import subprocess
import sys
import warnings

from ..errors import RefusalError


def _refuse(name, reason):
    raise RefusalError(f"{name}={os.environ.get(name)}: {reason}; unset this environment variable, or correct it")


def _check_threads():
    """Refuse a number of threads that numba fails on. It is for other programs: goniosim never uses those threads."""
    name = "NUMBA_NUM_THREADS"
    try:
        usable = int(os.environ.get(name, "1")) > 0
    except ValueError:
        usable = False
    if not usable:
        _refuse(name, "must be a whole number from 1 on (goniosim has threads of its own)")


def _check_readings(noted):
    """Refuse what numba could not read, and pass on other warnings."""
    for warning in noted:
        unread = re.match(r"Environment variable '(\w+)' is defined but", str(warning.message))
        if unread:
            _refuse(unread[1], "numba cannot read this value")
        warnings.warn_explicit(warning.message, warning.category, warning.filename, warning.lineno)


def _check_processor():
    """Refuse a processor that LLVM does not know: it would end the process. Tried in another one, if one is named."""
    named = [name for name in ("NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES") if os.environ.get(name)]
    if named:
        trial = [sys.executable, "-c", "from numba import njit; njit(lambda x: x + 1)(1)"]
        done = subprocess.run(trial, capture_output=True, check=False)
        if done.returncode or b"not a recognized" in done.stderr:
            _refuse(named[0], "numba cannot compile for this processor")


_check_threads()
with warnings.catch_warnings(record=True) as _noted:
    warnings.simplefilter("always")
    from llvmlite import ir
    from numba import __version__ as numba_version
    from numba import config, njit, types
    from numba.extending import intrinsic
_check_readings(_noted)
_check_processor()
if config.DISABLE_JIT:
    _refuse("NUMBA_DISABLE_JIT", "goniosim has no use for uncompiled code")

__all__ = ["config", "intrinsic", "ir", "njit", "numba_version", "types"]
