"""goniosim, a virtual goniometer: Monte Carlo BRDF and BTDF slices of layered materials.

>>> import goniosim
>>> result = goniosim.simulate("scene.yaml", rays=1e4)
>>> result.components["reflection/internal"].bsdf.shape
(2, 3, 9, 36)
>>> result.save("coated.h5").name
'coated.h5'

Importing the package loads nothing heavy: each name brings its own machinery when first used.
"""

from __future__ import annotations

from importlib import import_module as _import_module
from typing import TYPE_CHECKING as _TYPE_CHECKING

if _TYPE_CHECKING:
    from goniosim import errors
    from goniosim.api import simulate, simulate_study
    from goniosim.compare import compare
    from goniosim.errors import GoniosimError
    from goniosim.models import evaluate_model
    from goniosim.result import Result
    from goniosim.scene import Scene, load_scene, load_scenes
    from goniosim.store import open_result

    __version__: str

__all__ = [
    "GoniosimError",
    "Result",
    "Scene",
    "__version__",
    "compare",
    "errors",
    "evaluate_model",
    "load_scene",
    "load_scenes",
    "open_result",
    "simulate",
    "simulate_study",
]

_HOMES = {
    "GoniosimError": "goniosim.errors",
    "Result": "goniosim.result",
    "Scene": "goniosim.scene",
    "evaluate_model": "goniosim.models",
    "load_scene": "goniosim.scene",
    "load_scenes": "goniosim.scene",
    "open_result": "goniosim.store",
    "simulate": "goniosim.api",
    "simulate_study": "goniosim.api",
}
# Modules; that of `compare` can itself be called.
_MODULES = ("compare", "errors")


def __getattr__(name: str) -> object:
    if name in _HOMES:
        value = getattr(_import_module(_HOMES[name]), name)
    elif name in _MODULES:
        value = _import_module(f"goniosim.{name}")
    elif name == "__version__":
        value = _import_module("importlib.metadata").version("goniosim")
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
