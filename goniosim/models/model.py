"""What every analytic model offers: two verbs, its citation and its options."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

COMPONENTS = ("reflection", "reflection/direct", "reflection/internal", "transmission")

# Directions in one call of a kernel: their scratch arrays fit in a core's own cache.
BLOCK = 4096


@dataclass(frozen=True)
class Prepared:
    """A model ready to be evaluated for one material, one incident direction and one component.

    Attributes
    ----------
    kernel : callable
        Compiled ``kernel(tables, light, x, y, z, out)``: writes the BSDF in 1/sr, without the
        cosine, into ``out`` [distinct channel, n] for the unit view directions (x, y, z), z > 0.
        For transmission the view directions are mirrored to the upper side. It releases the GIL.
    tables : tuple of ndarray
        What the kernel needs of the material and the incident direction.
    light : ndarray, shape (3,)
        Unit vector whose mirror image the lobes follow: the direction to the light, or for
        transmission the mirrored direction in which the stack refracts the light.
    mirror_energy : ndarray, shape (distinct channels,)
        Fraction of the incident flux that leaves in exactly the mirror direction: the lobes of
        smooth interfaces, which no value per steradian can hold. Most often zero.
    position : list of int
        Of each channel of the scene, its place among the distinct ones.
    narrowest : float
        GGX width of the narrowest lobe that has values per steradian, for those who integrate it.
    """

    kernel: Callable
    tables: tuple
    light: np.ndarray
    mirror_energy: np.ndarray
    position: list
    narrowest: float

    @property
    def channels(self) -> int:
        """Rows that the kernel fills."""
        return len(self.mirror_energy)

    def evaluate(self, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
        """BSDF for view directions.

        Parameters
        ----------
        x, y, z : ndarray, shape (n,)
            Unit vectors, z > 0; mirrored to the upper side for transmission.

        Returns
        -------
        ndarray, shape (distinct channels, n)
            In 1/sr, without the cosine and without ``mirror_energy``.
        """
        x, y, z = (np.ascontiguousarray(a, dtype=float) for a in (x, y, z))
        values = np.empty((len(self.mirror_energy), len(x)))
        for start in range(0, len(x), BLOCK):
            part = slice(start, min(start + BLOCK, len(x)))
            block = np.empty((len(values), part.stop - start))
            self.kernel(self.tables, self.light, x[part], y[part], z[part], block)
            values[:, part] = block
        return values


@dataclass(frozen=True)
class Model:
    """A published analytic model of layered materials.

    Attributes
    ----------
    name : str
    citation : str
    applies_to : str
        The materials and components that it covers, in a few words.
    options : type
        Frozen dataclass of its options, see `goniosim.models.options`.
    supports : callable
        ``supports(scene, component)``: None if the model applies, else one sentence why not. What
        applies to any component applies to ``reflection``; direct and internal go together.
    prepare : callable
        ``prepare(scene, theta_i_deg, component, options) -> Prepared``.
    """

    name: str
    citation: str
    applies_to: str
    options: type
    supports: Callable
    prepare: Callable
