"""For which processor code is compiled."""

import re

from llvmlite import binding
from numba.core.codegen import get_host_cpu_features

from .environment import config

# Names of vector extensions: those of x86, ARM, POWER and RISC-V.
_VECTORS = re.compile(r"\+((avx|sse|fma|neon|sve|altivec|vsx|zve).*|v)")


def target():
    """Processor that LLVM compiles for.

    Returns
    -------
    name : str
    vectors : list of str
        Vector extensions that it may use.
    """
    features = get_host_cpu_features() if config.CPU_FEATURES is None else config.CPU_FEATURES
    found = map(_VECTORS.fullmatch, features.split(","))
    return config.CPU_NAME or binding.get_host_cpu_name(), sorted(match[1] for match in found if match)
