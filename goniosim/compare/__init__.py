"""Published models on the cells of a simulated slice, with errors that know their noise.

The package can be called: ``goniosim.compare(results)`` is `goniosim.compare.compare`.
"""

import sys
from types import ModuleType

from .comparison import Comparison, compare
from .material import MaterialComparison

__all__ = ["Comparison", "MaterialComparison", "compare"]


class _Callable(ModuleType):
    """Once this package is imported, its name in goniosim is the package, so the package answers the call."""

    __call__ = staticmethod(compare)


sys.modules[__name__].__class__ = _Callable
