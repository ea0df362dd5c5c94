"""What can be integrated."""

from collections.abc import Callable
from typing import Protocol

import numpy as np


class Density(Protocol):
    """A compiled function of the view direction, with what it needs to know."""

    @property
    def kernel(self) -> Callable:
        """Compiled ``kernel(tables, light, x, y, z, out)``, which releases the GIL.

        It writes values per steradian, without the cosine, into ``out`` [channel, n] for unit view
        directions (x, y, z), z > 0.
        """

    @property
    def tables(self) -> tuple:
        """Passed on to the kernel."""

    @property
    def light(self) -> np.ndarray:
        """Unit vector, passed on to the kernel; the lobes follow its mirror image."""

    @property
    def channels(self) -> int:
        """Rows of ``out``."""
