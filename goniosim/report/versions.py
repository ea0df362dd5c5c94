"""All that a bug report needs to know of the place where goniosim runs."""

import os
import platform

from .. import provenance
from ..cores import available_cores
from . import text

PACKAGES = (
    "numba",
    "llvmlite",
    "numpy",
    "h5py",
    "matplotlib",
    "click",
    "tqdm",
    "pydantic",
    "ruamel.yaml",
)
# Variables that change how fast, or whether, compiled code runs.
VARIABLES = ("NUMBA_", "OMP_", "OPENBLAS_", "MKL_", "HDF5_")


def as_data():
    """Versions, machine, compiler and environment.

    Returns
    -------
    dict of str to dict of str to str
        What cannot be found out says why.
    """
    return {
        "versions": {
            "goniosim": provenance.version_of("goniosim"),
            "git_revision": provenance.git_revision() or "none",
            "python": f"{platform.python_version()} ({platform.python_implementation()})",
            **{name: provenance.version_of(name) for name in PACKAGES},
            "libhdf5": _libhdf5(),
        },
        "machine": {
            "operating_system": provenance.operating_system(),
            "processor": provenance.processor(),
            "architecture": platform.machine(),
            "cores": f"{available_cores()} of {os.cpu_count()}",
        },
        "compiler": _compiler(),
        "environment": {name: value for name, value in sorted(os.environ.items()) if name.startswith(VARIABLES)},
    }


def description():
    """The same as text.

    Returns
    -------
    str
    """
    found = as_data()
    titles = {
        "versions": "Versions",
        "machine": "Machine",
        "compiler": "Compiler",
        "environment": "Environment variables",
    }
    blocks = [[title, *(text.pairs(found[name]) or ["  none is set"])] for name, title in titles.items()]
    return "\n\n".join("\n".join(lines) for lines in blocks)


def _libhdf5():
    try:
        from ..store import hdf5_version
    except Exception as error:
        return _failed(error)
    return hdf5_version


def _compiler():
    # A report about a broken installation is the one that is needed most.
    try:
        from .._jit.folder import CACHE_FOLDER, notices
        from .._jit.target import target

        name, vectors = target()
    except Exception as error:
        return {"unusable": _failed(error)}
    found = {"target": name, "vectors": ", ".join(vectors) or "none", "cache": str(CACHE_FOLDER or "none")}
    return found | {f"cache_notice_{number}": notice for number, notice in enumerate(notices, 1)}


def _failed(error):
    return " ".join(f"{type(error).__name__}: {error}".split())
