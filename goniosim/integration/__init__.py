"""Integrals of compiled densities over the cells of a slice, fixed or adaptive, to a stated tolerance.

A *density* is anything with a compiled ``kernel(tables, light, x, y, z, out)``, which writes values per
steradian into ``out`` [channel, n] for view directions (x, y, z), and with the ``tables`` and ``light`` to
hand to it: see `Density`. The energy of a cell is the integral over it of the density times cos(theta_v).
"""

from .adaptive import Adaptive, integrate_adaptively
from .density import Density
from .fixed import integrate_fixed
from .grid import Grid
from .lobe import Lobe, find_lobe
from .pool import Pool

__all__ = [
    "Adaptive",
    "Density",
    "Grid",
    "Lobe",
    "Pool",
    "find_lobe",
    "integrate_adaptively",
    "integrate_fixed",
]
