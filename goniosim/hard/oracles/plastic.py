"""Directions in which light leaves a smooth absorbing coat over a Lambertian base: the share of all that leaves."""

from collections.abc import Callable

import numpy as np

from ...scene import Scene
from . import fresnel

_NODES = 200


def exitance(scene: Scene) -> Callable[[np.ndarray], np.ndarray]:
    """Return the share per steradian of the internal reflection, of all channels, as a function of cos(theta_v)."""
    coat = scene.material.interfaces[0].eta
    (tau,) = scene.material.tau

    def density(height: np.ndarray) -> np.ndarray:
        # The base lights all directions below the coat alike; what enters at an angle leaves at the same.
        _, through = fresnel.dielectric(height, coat)
        below = np.sqrt((coat - 1.0) * (coat + 1.0) + height * height) / coat
        return np.array([through * height * np.exp(-depth / below) for depth in tau])

    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    total = np.pi * density(0.5 * (nodes + 1.0)) @ weights
    return lambda height: density(height) / total.reshape(-1, *[1] * np.ndim(height))
